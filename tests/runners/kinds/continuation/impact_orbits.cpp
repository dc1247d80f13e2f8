// Orbits of oscillators with impacts against their closed forms.
#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/runners/kinds/continuation/tube_study.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace impact_orbits_tests {

namespace {

/// x'' + c x' + x = F cos ωt with a stop at d; of symmetric orbits with another one at −d.
struct Impacting {
  double damping = 0.1, pulsation = 1, stop = 1, restitution = 0.8;
  bool symmetric = false;

  double period() const { return 2 * std::numbers::pi / pulsation; }
  Eigen::Matrix2d flow(double time) const {
    Eigen::Matrix2d rate;
    rate << 0, 1, -1, -damping;
    return (rate * time).exp();
  }
  std::complex<double> response() const {
    return 1.0 / std::complex<double>(1 - pulsation * pulsation, damping * pulsation);
  }
};

/// One impact of speed v at the phase ωt₀, then the same after a period; of symmetric orbits after half of one at the
/// other stop.
struct ImpactOrbit {
  double speed = 0, time = 0;
  Eigen::Vector2d strobe;   ///< (x, x') at t = 0
  double largest = 0;       ///< |multiplier|, over half a period of symmetric orbits
  double at_minus_one = 0;  ///< ∏ (1 + μ)
};

/// With f = x − p, p the motion without stops: f(t₀) = v g₁, f'(t₀⁺) = v g₂ with (s − R) g = −(1 + e) (0, 1), R the
/// flow of a period and s = 1, or of half a period and s = −1. So p(t₀) = d − v g₁ and p'(t₀) = −v (e + g₂).
struct ImpactForm {
  Eigen::Vector2d g;
  explicit ImpactForm(const Impacting& one) {
    const double sign = one.symmetric ? -1 : 1;
    const Eigen::Matrix2d flow = one.flow(one.period() / (one.symmetric ? 2 : 1));
    g = -(1 + one.restitution) * (Eigen::Matrix2d::Identity() - sign * flow).inverse() * Eigen::Vector2d(0, 1);
  }
  /// |p|² at speed v.
  double reach(const Impacting& one, double v) const {
    const double slow = one.stop - v * g[0], fast = v * (one.restitution + g[1]) / one.pulsation;
    return slow * slow + fast * fast;
  }
  /// v at which |p| is least: two orbits meet there.
  double fold_speed(const Impacting& one) const {
    const double fast = (one.restitution + g[1]) / one.pulsation;
    return one.stop * g[0] / (g[0] * g[0] + fast * fast);
  }
};

/// The faster orbit at a force; nothing where there is none that stays inside its stops.
std::optional<ImpactOrbit> impact_orbit(const Impacting& one, double force) {
  const ImpactForm form(one);
  const Eigen::Vector2d& g = form.g;
  const double fast = (one.restitution + g[1]) / one.pulsation, a = g[0] * g[0] + fast * fast, b = one.stop * g[0],
               reach = std::abs(force) * std::abs(one.response()), c = one.stop * one.stop - reach * reach,
               root = b * b - a * c;
  if (root < 0) return std::nullopt;
  ImpactOrbit orbit;
  orbit.speed = (b + std::sqrt(root)) / a;
  if (!(orbit.speed > 0)) return std::nullopt;
  // p = Re(P e^{iωt}), p(t₀) = d − v g₁, p'(t₀) = −v (e + g₂).
  const std::complex<double> at_impact(one.stop - orbit.speed * g[0],
                                       orbit.speed * (one.restitution + g[1]) / one.pulsation);
  const std::complex<double> amplitude = force * one.response();
  const double phase = std::arg(at_impact / amplitude);
  const double turn = 2 * std::numbers::pi;
  orbit.time = (phase - turn * std::floor(phase / turn)) / one.pulsation;
  const auto p = [&](double t) {
    const std::complex<double> now = amplitude * std::polar(1.0, one.pulsation * t);
    return Eigen::Vector2d(now.real(), -one.pulsation * now.imag());
  };
  // Backwards from t₀ to 0 by a whole period less: after the impact at t₀ − T, or at t₀ − T/2 at the other stop.
  const double map = one.period() / (one.symmetric ? 2 : 1);
  double since = orbit.time;
  double side = 1;
  while (since > 0) {
    since -= map;
    if (one.symmetric) side = -side;
  }
  const Eigen::Vector2d after = orbit.speed * Eigen::Vector2d(g[0], g[1]);
  const auto state = [&](double t) { return Eigen::Vector2d(p(orbit.time + t) + one.flow(t) * after); };
  orbit.strobe = side * state(-since);
  if (one.symmetric) {
    // state(t) is that after the impact at d; x(t + T/2) = −x(t).
    CHECK(std::abs(state(map)[0] + one.stop) < 1e-9 * one.stop);
  }
  for (int k = 1; k < 400; ++k) {
    const double x = state(map * k / 400)[0];
    if (x > 0.999 * one.stop && k > 20 && k < 380) return std::nullopt;
    if (one.symmetric && x < -0.999 * one.stop && k < 380) return std::nullopt;
    if (x > one.stop || (one.symmetric && x < -one.stop)) return std::nullopt;
  }
  // S R: the flow of a map, then what an impact makes of it.
  const double load = force * std::cos(one.pulsation * orbit.time);
  const double before = load - one.stop - one.damping * orbit.speed,
               behind = load - one.stop + one.damping * one.restitution * orbit.speed, e = one.restitution;
  Eigen::Matrix2d jump;
  jump << -e, 0, (behind + e * before) / orbit.speed, -e;
  const Eigen::Matrix2d map_of = jump * one.flow(map);
  orbit.largest = map_of.eigenvalues().cwiseAbs().maxCoeff();
  orbit.at_minus_one = 1 + map_of.trace() + map_of.determinant();
  return orbit;
}

Json study_of(const Impacting& one, const std::string& time, double from, double to, double at, int steps) {
  Json study = Json::parse(R"({
    "name": "impacts", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "force": {"amplitude": 1}},
              "stops": {"at": "tip"}, "initial": {}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": {}},
    "parameter": {"pointer": "/scene/structure/force/amplitude"},
    "orbits": [{"from": "state", "periods": 5}], "switch": null
  })");
  study["scene"]["structure"]["damping"] = one.damping;
  study["scene"]["structure"]["force"]["pulsation"] = one.pulsation;
  study["scene"]["stops"]["upper"] = one.stop;
  if (one.symmetric) study["scene"]["stops"]["lower"] = -one.stop;
  study["methods"]["time"] = {{"name", time}, {"restitution", one.restitution}};
  study["parameter"]["from"] = from;
  study["parameter"]["to"] = to;
  study["orbits"][0]["at"] = at;
  study["steps_per_period"] = steps;
  if (const auto orbit = impact_orbit(one, at))
    study["scene"]["initial"] = {{"displacement", orbit->strobe[0]}, {"velocity", orbit->strobe[1]}};
  return study;
}

/// Along the pulsation of a force of 1 N, from what rest leads to, with the branches at its points.
Json from_rest(const Impacting& one, const std::string& time, double from, double to, int steps) {
  Json study = study_of(one, time, from, to, one.pulsation, steps);
  study["scene"].erase("initial");
  study["parameter"]["pointer"] = "/scene/structure/force/pulsation";
  study["orbits"] = {{{"at", one.pulsation}, {"from", "rest"}}};
  study.erase("switch");
  return study;
}

}  // namespace

TEST_CASE("the closed form of an impact orbit is that of the worked example of COCO") {
  const Impacting one;
  for (const auto& [force, x, v] :
       {std::tuple{1.0, 0.870835, 1.703820}, {0.5, 0.843285, 0.928070}, {0.2, 0.752604, 0.672890}}) {
    const auto orbit = impact_orbit(one, force);
    REQUIRE(orbit);
    CHECK(orbit->strobe[0] == Approx(x).margin(1e-6));
    CHECK(orbit->strobe[1] == Approx(v).margin(1e-6));
  }
  CHECK(std::sqrt(ImpactForm(one).reach(one, ImpactForm(one).fold_speed(one))) / std::abs(one.response()) ==
        Approx(0.0999708).margin(1e-7));
}

TEST_CASE("orbits with impacts are where their closed forms say: displacement, velocity, largest multiplier") {
  const std::string time = GENERATE("moreau-jean", "newmark-dumont-paoli");
  std::mt19937 random(29);
  std::uniform_real_distribution<double> share(0, 1);
  int found = 0;
  for (int times = 0; times < 400 && found < 6; ++times) {
    Impacting one;
    one.damping = 0.02 + 0.3 * share(random);
    one.pulsation = 0.6 + 2.2 * share(random);
    one.restitution = 0.4 + 0.5 * share(random);
    one.stop = 0.3 + share(random);
    one.symmetric = found % 2 == 1;
    const double force = (1.2 + 2 * share(random)) * one.stop / std::abs(one.response());
    const auto orbit = impact_orbit(one, force);
    // Stable ones, which the march before the solve stays with, that hit well inside their period.
    if (!orbit || orbit->largest > 0.9 || orbit->speed < 0.3 * one.stop * one.pulsation) continue;
    ++found;
    constexpr int steps = 4000;
    Json study = study_of(one, time, 0.9 * force, 1.1 * force, force, steps);
    study["follow"] = "none";
    const CaseRecord record = continued(study);
    INFO(time << " " << study.dump() << " " << record.reason());
    REQUIRE(record.status == Status::done);
    const BranchRow row = rows_of(record).front();
    CHECK(row.symmetric == one.symmetric);
    // An impact is placed with order 2; (ωh)² is 2.5e-6.
    const double reach = one.stop + orbit->speed / one.pulsation;
    CHECK(*row.tip_displacement == Approx(orbit->strobe[0]).margin(3e-4 * reach));
    CHECK(*row.tip_velocity == Approx(orbit->strobe[1]).margin(3e-4 * reach * one.pulsation));
    CHECK(std::abs(*row.multipliers.front()) == Approx(orbit->largest).margin(4e-3));
    // The march itself has its impacts up to a step late.
    const double h = one.period() / steps;
    CHECK(*row.march_displacement < 8 * h * (1 + one.restitution) * orbit->speed);
  }
  CHECK(found == 6);
}

TEST_CASE("impact orbits fold where their closed forms meet, within the interval") {
  const std::string time = GENERATE("moreau-jean", "newmark-dumont-paoli");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  int found = 0;
  for (int times = 0; times < 400 && found < 2; ++times) {
    Impacting one;
    one.damping = 0.05 + 0.2 * share(random);
    one.symmetric = found == 1;
    one.pulsation = 1.15 + (one.symmetric ? 1 : 0.4) * share(random);
    one.restitution = 0.5 + 0.4 * share(random);
    const ImpactForm form(one);
    const double speed = form.fold_speed(one);
    if (speed < 0.15) continue;
    const double fold = std::sqrt(form.reach(one, speed)) / std::abs(one.response()), at = 1.3 * fold;
    const auto orbit = impact_orbit(one, at), near = impact_orbit(one, 1.000001 * fold);
    if (!orbit || !near || orbit->largest > 0.9) continue;
    ++found;
    Json study = study_of(one, time, 0.5 * fold, 2 * fold, at, 2000);
    const CaseRecord record = continued(study);
    const std::vector<SpecialRow> points = points_of(record);
    INFO(time << " " << study.dump() << " " << record.reason());
    REQUIRE(record.status == Status::done);
    std::vector<SpecialRow> folds;
    for (const SpecialRow& point : points)
      if (point.kind == PointKind::fold) folds.push_back(point);
    REQUIRE(folds.size() == 1);
    CHECK(*folds[0].parameter == Approx(fold).epsilon(1e-4));
    CHECK(*folds[0].low <= fold);
    CHECK(*folds[0].high >= fold);
  }
  CHECK(found == 2);
}

TEST_CASE("impact orbits double their period where a multiplier of the closed form is −1") {
  const std::string time = GENERATE("moreau-jean", "newmark-dumont-paoli");
  std::mt19937 random(17);
  std::uniform_real_distribution<double> share(0, 1);
  int found = 0;
  for (int times = 0; times < 100 && found < 2; ++times) {
    Impacting one;
    one.damping = 0.05 * share(random);
    one.restitution = 0.6 + 0.3 * share(random);
    one.stop = 0.02 + 0.1 * share(random);
    const auto at = [&](double pulsation) {
      one.pulsation = pulsation;
      return impact_orbit(one, 1);
    };
    double low = 2.4, high = 0;
    if (!at(low) || at(low)->at_minus_one < 0) continue;
    for (double tried = low; tried < 3.2 && high == 0; tried += 0.02)
      if (const auto orbit = at(tried); !orbit)
        break;
      else
        (orbit->at_minus_one > 0 ? low : high) = tried;
    if (high == 0) continue;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (low + high);
      (at(middle)->at_minus_one > 0 ? low : high) = middle;
    }
    ++found;
    const double first = low - 0.01;
    one.pulsation = first;
    Json study = study_of(one, time, low - 0.015, low + 0.015, first, 2000);
    study["scene"]["structure"]["force"]["amplitude"] = 1;
    const auto orbit = impact_orbit(one, 1);
    REQUIRE(orbit);
    study["scene"]["initial"] = {{"displacement", orbit->strobe[0]}, {"velocity", orbit->strobe[1]}};
    study["parameter"]["pointer"] = "/scene/structure/force/pulsation";
    const CaseRecord record = continued(study);
    INFO(time << " " << low << " " << study.dump() << " " << record.reason());
    REQUIRE(record.status == Status::done);
    std::vector<SpecialRow> flips;
    for (const SpecialRow& point : points_of(record))
      if (point.kind == PointKind::flip) flips.push_back(point);
    REQUIRE(flips.size() == 1);
    CHECK(*flips[0].parameter == Approx(low).margin(3e-4));
    CHECK(*flips[0].low <= low);
    CHECK(*flips[0].high >= low);
  }
  CHECK(found == 2);
}

TEST_CASE(
    "a marked orbit has its own multipliers, and a doubled branch ends where its orbits repeat after one period") {
  Impacting one{.damping = 0.1, .pulsation = 2.4, .stop = 0, .restitution = 0.75};
  Json study = from_rest(one, "moreau-jean", 2.3, 2.85, 1000);
  study["orbits"][0]["periods"] = 200;
  study["mark"] = {{"parameter", {2.5, 2.65}}};
  const CaseRecord record = continued(study);
  INFO(record.reason());
  REQUIRE(record.status == Status::done);
  std::size_t marks = 0;
  std::map<double, double> single;  // tip of the orbits of period 1 by pulsation
  for (const BranchRow& row : rows_of(record)) {
    if (!row.parameter || row.period != 1) continue;
    single[*row.parameter] = *row.tip_displacement;
    if (*row.parameter != 2.5 && *row.parameter != 2.65) continue;
    ++marks;
    one.pulsation = *row.parameter;
    // ∏ (1 + μ) of the closed form; the multipliers of a rebound are first order in h.
    const auto orbit = impact_orbit(one, 1);
    REQUIRE(orbit);
    std::complex<double> product = 1;
    for (const auto& root : row.multipliers) product *= 1.0 + root.value_or(0);
    CHECK(product.real() == Approx(orbit->at_minus_one).margin(0.02));
  }
  CHECK(marks == 2);
  std::size_t doubled = 0;
  for (const BranchRow& row : rows_of(record)) {
    if (row.period != 2 || !row.parameter) continue;
    const auto same = single.find(*row.parameter);
    if (same != single.end()) CHECK(std::abs(*row.tip_displacement - same->second) > 1e-6);
    ++doubled;
  }
  CHECK(doubled > 0);
}

TEST_CASE("an impact that passes the instant at which periods begin changes nothing of its orbits") {
  // The phase of the force shifts an orbit in time: its impact goes once round the period.
  const std::string time = GENERATE("moreau-jean", "newmark-dumont-paoli");
  Impacting one;
  one.damping = 0.15;
  one.pulsation = 1.6;
  one.restitution = 0.7;
  one.stop = 0.4;
  const double force = 1.5;
  const auto orbit = impact_orbit(one, force);
  REQUIRE(orbit);
  REQUIRE(orbit->largest < 0.9);
  Json study = study_of(one, time, -3.2, 3.2, force, 600);
  study["scene"]["structure"]["force"]["amplitude"] = force;
  study["parameter"]["pointer"] = "/scene/structure/force/phase";
  study["orbits"][0]["at"] = 0;
  const CaseRecord record = continued(study);
  INFO(study.dump() << " " << record.reason());
  REQUIRE(record.status == Status::done);
  const std::vector<SpecialRow> points = points_of(record);
  CHECK(points.size() == 2);
  for (const SpecialRow& point : points) {
    CHECK(point.kind == PointKind::end);
    CHECK(std::abs(*point.parameter) == Approx(3.2));
  }
  std::size_t rows = 0;
  for (const BranchRow& row : rows_of(record)) {
    if (row.multipliers.empty() || !row.multipliers.front()) continue;
    ++rows;
    INFO(row.branch << " at " << *row.parameter);
    // First order in h, 0.7 % of a period.
    CHECK(std::abs(*row.multipliers.front()) == Approx(orbit->largest).margin(0.02));
    CHECK(row.impacts_per_period == 1);
  }
  CHECK(rows > 20);
}

TEST_CASE("a branch with rebounds keeps to its scene, and its doubled orbits are none that it had") {
  // Beyond 2.03 rad/s the orbits meet the lower stop too: Newton's method runs off there.
  Impacting one;
  one.damping = 0.05;
  one.restitution = 0.75;
  one.stop = 0.2;
  one.pulsation = 2.2;
  Json study = from_rest(one, "newmark-dumont-paoli", 2.0, 2.3, 2000);
  study["scene"]["stops"]["lower"] = -2.5;
  const CaseRecord record = continued(study);
  INFO(record.reason());
  REQUIRE(record.status == Status::done);
  std::map<double, double> single;  // tip of the orbits of period 1 by pulsation
  std::size_t doubled = 0;
  for (const BranchRow& row : rows_of(record)) {
    if (!row.parameter || !row.tip_displacement) continue;
    INFO(row.branch << " at " << *row.parameter);
    // Impacts are placed within a step of about 1e-3 s at less than 3 m/s.
    CHECK(*row.tip_displacement < 0.21);
    CHECK(*row.tip_displacement > -2.51);
    CHECK(std::abs(row.tip_velocity.value_or(0)) < 10);
    if (row.period == 1) single[*row.parameter] = *row.tip_displacement;
  }
  for (const BranchRow& row : rows_of(record)) {
    if (row.period != 2 || !row.parameter || !row.tip_displacement || *row.parameter < 2.268) continue;
    const auto beside = single.lower_bound(*row.parameter);
    if (beside == single.end()) continue;
    ++doubled;
    // The exact doubled orbit at 2.27 has strobes at −0.395 and −0.539, the single one at −0.45.
    CHECK(std::abs(*row.tip_displacement - beside->second) > 0.005);
  }
  CHECK(doubled > 0);
}

}  // namespace impact_orbits_tests
