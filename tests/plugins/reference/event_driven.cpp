// The event-driven reference against semi-analytic figures, closed forms of the continuous beam, and laws that every
// motion obeys.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <ricochet/loader/catalogue.hpp>

using namespace ricochet;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double length = 1.501;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::unique_ptr<ReferenceSolver> solver(std::map<std::string, ParameterValue> values = {}) {
  static Catalogue catalogue(RICOCHET_PLUGIN_DIR, {}, {});
  static Registry registry;
  REQUIRE(catalogue.require(Role::reference, "event-driven", registry));
  const auto* entry = registry.reference("event-driven");
  REQUIRE(entry);
  for (const auto& spec : entry->manual.parameters)
    if (spec.fallback && !values.contains(spec.key)) values[spec.key] = *spec.fallback;
  return entry->make(Parameters(values));
}

/// Steel tube 10 mm × 0.5 mm, stops ±0.1 m at the tip, u0 = 0.04x², v0 = −2x.
ReferenceProblem free_problem(double alpha) {
  const double outer = 0.01, inner = 0.009;
  ReferenceProblem problem;
  problem.structure = "beam";
  problem.length = length;
  problem.stiffness = 2e11 * pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4));
  problem.inertia = 8000 * pi / 4 * (outer * outer - inner * inner);
  problem.damping_stiffness = alpha;
  problem.left_fixed = true;
  problem.support_pulsation = 10;
  problem.displacement = [](double x) { return 0.04 * x * x; };
  problem.velocity = [](double x) { return -2 * x; };
  problem.stops_at_tip = true;
  problem.stop_places = {length};
  problem.lower = [](double) { return -0.1; };
  problem.upper = [](double) { return 0.1; };
  return problem;
}

ReferenceProblem still_problem(double alpha) {
  ReferenceProblem problem = free_problem(alpha);
  problem.displacement = problem.velocity = [](double) { return 0.0; };
  return problem;
}

/// From rest in the laboratory, support A₀ sin 10t.
ReferenceProblem forced_problem(double amplitude, double alpha) {
  ReferenceProblem problem = still_problem(alpha);
  problem.support_amplitude = amplitude;
  return problem;
}

ReferenceProblem without_stops(ReferenceProblem problem) {
  problem.lower = [](double) { return -infinity; };
  problem.upper = [](double) { return infinity; };
  return problem;
}

ReferenceMotion solved(const ReferenceProblem& problem, const SampleGrid& grid,
                       const std::map<std::string, ParameterValue>& values = {}) {
  auto result = solver(values)->solve(problem, grid);
  INFO((std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(result));
  return std::get<ReferenceMotion>(result);
}

std::string refused(const ReferenceProblem& problem, const std::map<std::string, ParameterValue>& values = {}) {
  const auto result = solver(values)->solve(problem, {{0, 0.5}, {}, {}});
  return std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence : "";
}

std::vector<double> spread(double end, int count) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(end * i / count);
  return times;
}

bool mentions(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// First clamped–free mode, φ(L) = 1.
constexpr double first_root = 1.8751040687119611664;
double first_mode(double x) {
  const double a = first_root * x / length, z = first_root;
  const double sigma = (std::cosh(z) + std::cos(z)) / (std::sinh(z) + std::sin(z));
  return 0.5 * (std::cosh(a) - std::cos(a) - sigma * (std::sinh(a) - std::sin(a)));
}
double first_pulsation(const ReferenceProblem& problem) {
  return std::pow(first_root / length, 2) * std::sqrt(problem.stiffness / problem.inertia);
}

/// Undamped steady shape on a support that moves by sin ωt, u = U(x) sin ωt, of the differential equation itself.
struct SteadyShape {
  explicit SteadyShape(const ReferenceProblem& problem)
      : wave(std::sqrt(problem.support_pulsation / std::sqrt(problem.stiffness / problem.inertia))) {
    const double z = wave * length, c = std::cos(z), s = std::sin(z), C = std::cosh(z), S = std::sinh(z);
    // U = a cos + (1 − a) cosh + b (sin − sinh), U'' = U''' = 0 at L.
    const Eigen::Matrix2d ends{{-c - C, -s - S}, {s - S, -c - C}};
    const Eigen::Vector2d solution = ends.inverse() * Eigen::Vector2d(-C, -S);
    a = solution(0);
    b = solution(1);
  }
  double operator()(double x) const {
    const double y = wave * x;
    return a * std::cos(y) + (1 - a) * std::cosh(y) + b * (std::sin(y) - std::sinh(y));
  }
  double wave, a = 0, b = 0;
};

}  // namespace

TEST_CASE("free damped beam: every impact, release, velocity and energy of the semi-analytic solution") {
  const double E0 = 2.0 / 3 * std::pow(length, 3) + 0.5 * 282.8125 * 0.0064 * length;
  const ReferenceProblem problem = free_problem(1e-4);
  const auto modes = GENERATE(40LL, 80LL, 160LL);
  const ReferenceMotion found = solved(problem, {{0, 0.4}, {}, {}}, {{"modes", modes}});
  const std::vector<ContactEvent> table = {{0.0487745646, -1, true, -3.85453013}, {0.0598140489, -1, false, 0},
                                           {0.1592507858, +1, true, +1.39190292}, {0.1666838954, +1, false, 0},
                                           {0.1684825520, +1, true, +0.16964822}, {0.1710816835, +1, false, 0},
                                           {0.2582968934, -1, true, -1.13119883}, {0.2697290967, -1, false, 0},
                                           {0.3645463046, +1, true, +1.16836297}, {0.3720931374, +1, false, 0}};
  // Half a unit of the last digit printed, and a little.
  for (const SampledMotion* motion : {&found.motion, &found.coarser}) {
    REQUIRE(motion->events.size() == table.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
      CHECK(motion->events[i].side == table[i].side);
      CHECK(motion->events[i].begins == table[i].begins);
      CHECK(std::abs(motion->events[i].time - table[i].time) < 0.7e-10);
      CHECK(std::abs(motion->events[i].velocity - table[i].velocity) < 0.7e-8);
    }
    CHECK(std::abs(motion->tip[1] - 0.060859417359) < 0.7e-12);
    CHECK(std::abs(motion->energy[1] / problem.inertia - 1.55776753366) < 0.7e-11);
    // The formulas at t = 0 are read, not summed; the last printed digit of EI/ρS leaves 1e-12.
    CHECK(motion->energy[0] / problem.inertia == Approx(E0).epsilon(1e-10));
  }
  CHECK(found.notes.empty());
}

TEST_CASE("period-1 orbits of the forced beam, from rest") {
  struct Orbit {
    double amplitude, tip;
    std::vector<double> impacts;
  };
  const auto orbit = GENERATE(
      Orbit{0.080, -0.01991978, {1.209644, 0.213837, 0.636535, 1.045161, -1.209644, -0.213837, -0.636535, -1.045161}},
      Orbit{0.086, -0.02583080, {1.582296, 0.914187, 0.915527, -1.255223}},
      Orbit{0.099, -0.01112840, {0.748404, 1.199867, -0.748404, -1.199867}});
  const double period = 2 * pi / 10;
  // Transients are below 1e-9 after 60 periods, those at 0.086 being the longest.
  const ReferenceMotion found =
      solved(forced_problem(orbit.amplitude, 1e-4), {{0, 80 * period, 81 * period}, {}, {}}, {{"modes", 40LL}});
  const SampledMotion& motion = found.motion;
  CHECK(std::abs(motion.tip[1] - orbit.tip) < 0.7e-8);
  CHECK(std::abs(motion.tip[2] - motion.tip[1]) < 1e-9);
  std::vector<double> impacts;
  for (const ContactEvent& event : motion.events)
    if (event.begins && event.time > 80 * period) impacts.push_back(event.velocity);
  REQUIRE(impacts.size() == orbit.impacts.size());
  for (std::size_t i = 0; i < impacts.size(); ++i) CHECK(std::abs(impacts[i] - orbit.impacts[i]) < 0.7e-6);
}

TEST_CASE("the grazing amplitude of the undamped beam separates motions that touch from motions that do not") {
  ReferenceProblem problem = still_problem(0);
  const SteadyShape shape(problem);
  const double z = length * shape.wave;
  const double grazing = 0.1 * (1 + std::cos(z) * std::cosh(z)) / (std::cos(z) + std::cosh(z));
  CHECK(std::abs(z - 1.157460134878) < 1e-12);
  CHECK(std::abs(grazing - 0.0791792098) < 0.6e-10);
  const auto steady = [&](double amplitude) {
    ReferenceProblem moving = problem;
    moving.support_amplitude = amplitude;
    moving.velocity = [=](double x) { return 10 * amplitude * shape(x); };
    return moving;
  };
  const double quarter = 2 * pi / 40;
  const SampleGrid grid{{0, quarter, 2 * quarter, 3 * quarter, 50 * quarter}, {0.5, 1.2}, {}};
  const ReferenceMotion free = solved(without_stops(steady(grazing)), grid);
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    // Modes left out of the sum: about 1e-11 of the tip at 80 modes.
    CHECK(std::abs(free.motion.tip[i] - 0.1 * std::sin(10 * grid.times[i])) < 1e-10);
    for (std::size_t j = 0; j < 2; ++j)
      CHECK(std::abs(free.motion.displacement[2 * i + j] -
                     grazing * shape(grid.places[j]) * std::sin(10 * grid.times[i])) < 1e-10);
  }
  // One part in 10⁸ below and above.
  CHECK(solved(steady(grazing * (1 - 1e-8)), grid).motion.events.empty());
  const ReferenceMotion touching = solved(steady(grazing * (1 + 1e-8)), grid, {{"modes", 40LL}});
  REQUIRE_FALSE(touching.motion.events.empty());
  CHECK(std::abs(touching.motion.events[0].time - quarter) < 1e-4);
  CHECK(touching.motion.events[0].side == 1);
}

TEST_CASE("one mode alone swings, creeps or does both, as its damping says") {
  ReferenceProblem problem = without_stops(still_problem(0));
  const double omega = first_pulsation(problem);
  CHECK(omega == Approx(26.244522).epsilon(2e-8));
  // αω/2: under, exactly at and above critical; η alone; both.
  const auto [ratio, eta] = GENERATE(table<double, double>({{0, 0}, {1e-3, 0}, {1, 0}, {3, 0}, {0, 40}, {0.2, 3}}));
  problem.damping_stiffness = 2 * ratio / omega;
  problem.damping_mass = eta;
  problem.displacement = [](double x) { return 0.05 * first_mode(x); };
  problem.velocity = [](double x) { return 0.3 * first_mode(x); };
  const SampleGrid grid{spread(0.5, 20), {0.7}, {}};
  const ReferenceMotion found = solved(problem, grid);
  const double zeta = 0.5 * (problem.damping_stiffness * omega * omega + eta), y0 = 0.05, v0 = 0.3;
  const std::complex<double> split = std::sqrt(std::complex<double>(zeta * zeta - omega * omega));
  const bool critical = std::abs(split) < 1e-5 * omega;
  for (std::size_t i = 0; i < grid.times.size(); ++i) {
    const double t = grid.times[i];
    const double expected =
        critical ? std::exp(-zeta * t) * (y0 + (v0 + zeta * y0) * t)
                 : std::real(std::exp(-zeta * t) *
                             (y0 * std::cosh(split * t) + (v0 + zeta * y0) * std::sinh(split * t) / split));
    // Round-off of the quadrature of 80 modes; the critical case is within 1e-16 of the confluent formula.
    CHECK(std::abs(found.motion.tip[i] - expected) < 1e-13);
    CHECK(std::abs(found.motion.displacement[i] - expected * first_mode(0.7)) < 1e-13);
  }
}

TEST_CASE("without damping and contact the energy stays what it is at the start") {
  // The initial displacement is bent at the free end: modes left out hold 0.2 % of its energy, and keep it.
  const ReferenceProblem problem = without_stops(free_problem(0));
  const ReferenceMotion found = solved(problem, {spread(0.4, 50), {}, {}});
  for (const double energy : found.motion.energy) CHECK(energy == Approx(found.motion.energy[0]).epsilon(1e-12));
  CHECK(mentions(found.notes, "bends the beam at its free end"));
  for (const double impulse : found.motion.impulse) CHECK(impulse == 0);
}

TEST_CASE("undamped contact: slow convergence that is said, energy that never grows") {
  const ReferenceProblem problem = free_problem(0);
  const ReferenceMotion found = solved(problem, {spread(0.1, 400), {}, {}}, {{"modes", 40LL}});
  CHECK(mentions(found.notes, "converge slowly"));
  REQUIRE(found.motion.events.size() > 2);
  // Before the first impact only the start is truncated.
  CHECK(std::abs(found.motion.events[0].time - found.coarser.events[0].time) < 3e-6);
  for (std::size_t i = 1; i < found.motion.energy.size(); ++i)
    CHECK(found.motion.energy[i] <= found.motion.energy[i - 1] * (1 + 1e-12));
  // Finer modes keep more of it.
  CHECK(found.motion.energy.back() > found.coarser.energy.back());
  CHECK(found.motion.energy.back() > 0.9 * found.motion.energy[0]);
}

TEST_CASE("the tip stays between its stops, and a stop only pushes") {
  const auto forced = GENERATE(false, true);
  const ReferenceProblem problem = forced ? forced_problem(0.095, 1e-4) : free_problem(1e-4);
  const SampleGrid grid{spread(1.5, 6000), {}, {}};
  const SampledMotion motion = solved(problem, grid).motion;
  REQUIRE(motion.events.size() > 8);
  std::size_t event = 0;
  int side = 0;
  bool flown = false, held = false;
  for (std::size_t i = 1; i < grid.times.size(); ++i) {
    bool changed = false;
    for (; event < motion.events.size() && motion.events[event].time <= grid.times[i]; ++event) {
      side = motion.events[event].begins ? motion.events[event].side : 0;
      changed = true;
    }
    // The hair by which the sum of 80 modes may pass a stop after a release; 40 leave eight times as much.
    CHECK(std::abs(motion.tip[i]) <= 0.1 + 1e-8);
    if (side != 0) CHECK(motion.tip[i] == 0.1 * side);
    if (side != 0) CHECK(motion.tip_velocity[i] == 0);
    if (changed) continue;
    // Round-off of an impulse that is the difference of two momenta.
    const double push = motion.impulse[i] - motion.impulse[i - 1];
    if (side == 0) CHECK(push == 0);
    if (side != 0) CHECK(push * -side > -1e-13);
    (side == 0 ? flown : held) = true;
  }
  CHECK(flown);
  CHECK(held);
  if (!forced)
    for (std::size_t i = 1; i < grid.times.size(); ++i) CHECK(motion.energy[i] <= motion.energy[i - 1]);
}

TEST_CASE("impulses of the stops balance the momentum of the beam") {
  // Against the lift p = x²(3L − x)/(2L³), whose fourth derivative is zero:
  //   ∫P dt = ρS[⟨w_t,p⟩ + η⟨w,p⟩ + φ'⟨1,p⟩] + 3EI/L³ (∫w(L)dt + α[w(L)]) − t⟨f,p⟩, brackets from 0 to t.
  ReferenceProblem problem = free_problem(1e-4);
  problem.support_amplitude = 0.04;
  problem.support_pulsation = 30;
  problem.velocity = [](double x) { return 1.2 - 2 * x * x; };
  problem.damping_mass = 2;
  problem.load = [](double, double) { return -0.2; };
  problem.load_zero = false;
  SampleGrid grid{spread(0.4, 20000), {}, {}};
  const int cells = 400;
  for (int i = 0; i < cells; ++i)
    for (const double gauss : {-std::sqrt(1.0 / 12), std::sqrt(1.0 / 12)})
      grid.places.push_back((i + 0.5 + gauss) * length / cells);
  SampleGrid ends{{0, 0.4}, grid.places, {}};
  grid.places.clear();
  const SampledMotion fine = solved(problem, grid).motion;
  const SampledMotion shape = solved(problem, ends).motion;
  REQUIRE(fine.events.size() > 3);
  const auto against_lift = [&](const std::vector<double>& field, std::size_t row) {
    double sum = 0;
    for (std::size_t i = 0; i < ends.places.size(); ++i) {
      const double x = ends.places[i];
      sum += field[row * ends.places.size() + i] * x * x * (3 * length - x) / (2 * std::pow(length, 3));
    }
    return sum * length / (2 * cells);
  };
  // Displacements of w at both ends of time: u − φ.
  const double phi = 0.04 * std::sin(30 * 0.4), lift_mean = 3 * length / 8;
  double tip_integral = 0;
  for (std::size_t i = 1; i < fine.tip.size(); ++i) tip_integral += 0.5 * (fine.tip[i] + fine.tip[i - 1]) * 0.4 / 20000;
  tip_integral -= 0.04 / 30 * (1 - std::cos(30 * 0.4));
  const double expected =
      problem.inertia *
          (against_lift(shape.velocity, 1) - against_lift(shape.velocity, 0) +
           2 * (against_lift(shape.displacement, 1) - phi * lift_mean - against_lift(shape.displacement, 0))) +
      3 * problem.stiffness / std::pow(length, 3) * (tip_integral + 1e-4 * (fine.tip.back() - phi - fine.tip[0])) +
      0.4 * 0.2 * lift_mean;
  // Trapezes in t of a tip with kinks at impacts: about 3e-9 here.
  CHECK(fine.impulse.back() == Approx(expected).epsilon(3e-7));
  CHECK(fine.impulse.back() == Approx(shape.impulse.back()).epsilon(1e-12));
}

TEST_CASE("a beam that rests on its stop under its weight stays there, and weighs 3qL/8 − 3EIδ/L³") {
  const double load = 2.0, drop = GENERATE(0.0, 0.01);
  ReferenceProblem problem = still_problem(GENERATE(1e-4, 0.0));
  problem.load = [=](double, double) { return -load; };
  problem.load_zero = false;
  problem.lower = [=](double) { return -drop; };
  const double EI = problem.stiffness;
  REQUIRE(load < 72 * EI * 0.02 / std::pow(length, 4));
  const double reaction = 3 * load * length / 8 - 3 * EI * drop / std::pow(length, 3);
  REQUIRE(reaction > 0);
  problem.displacement = [=](double x) {
    const double L = length;
    return (-load * x * x * (6 * L * L - 4 * L * x + x * x) / 24 + reaction * x * x * (3 * L - x) / 6) / EI;
  };
  const ReferenceMotion found = solved(problem, {spread(2, 8), {1.0}, {}});
  // It has lain there from the start: nothing begins, and nothing ends.
  CHECK(found.motion.events.empty());
  for (std::size_t i = 0; i <= 8; ++i) {
    CHECK(std::abs(found.motion.tip[i] + drop) < 1e-12);
    CHECK(found.motion.impulse[i] == Approx(reaction * 0.25 * static_cast<double>(i)).epsilon(1e-9).margin(1e-12));
    CHECK(std::abs(found.motion.displacement[i] - problem.displacement(1.0)) < 1e-9);
  }
}

TEST_CASE("a constant load alone bends the beam as statics says") {
  ReferenceProblem problem = without_stops(still_problem(1e-2));
  problem.load = [](double x, double) { return 0.5 * x; };
  problem.load_zero = false;
  const SampledMotion motion = solved(problem, {{0, 10}, {}, {}}).motion;
  // Triangular load q x/L with q = L/2: 11qL⁴/(120EI). What is left of the start is e^{−34}.
  CHECK(motion.tip[1] == Approx(11 * 0.5 * length * std::pow(length, 4) / (120 * problem.stiffness)).epsilon(1e-9));
}

TEST_CASE("a tip held between two stops that meet never leaves them") {
  ReferenceProblem problem = forced_problem(0.05, 1e-4);
  problem.lower = problem.upper = [](double) { return 0.0; };
  const SampledMotion motion = solved(problem, {spread(1, 40), {}, {}}).motion;
  for (const double tip : motion.tip) CHECK(tip == 0);
  CHECK(*std::min_element(motion.impulse.begin(), motion.impulse.end()) < 0);
}

TEST_CASE("the motion is the mirrored one in the mirror, and scales with its scene") {
  const SampleGrid grid{spread(0.4, 8), {1.0}, {}};
  const SampledMotion motion = solved(free_problem(1e-4), grid).motion;

  ReferenceProblem mirrored = free_problem(1e-4);
  mirrored.displacement = [](double x) { return -0.04 * x * x; };
  mirrored.velocity = [](double x) { return 2 * x; };
  const SampledMotion mirror = solved(mirrored, grid).motion;
  REQUIRE(mirror.events.size() == motion.events.size());
  for (std::size_t i = 0; i < motion.events.size(); ++i) CHECK(mirror.events[i].side == -motion.events[i].side);
  for (std::size_t i = 0; i < motion.tip.size(); ++i) CHECK(std::abs(mirror.tip[i] + motion.tip[i]) < 1e-14);

  // All displacements times s, masses and stiffnesses times m, times over c.
  const auto scale = GENERATE(table<double, double, double>({{1e-6, 1, 1}, {1e5, 1, 1}, {1, 1e6, 1}, {1, 1, 1e3}}));
  const double s = std::get<0>(scale), m = std::get<1>(scale), c = std::get<2>(scale);
  ReferenceProblem scaled = free_problem(1e-4 / c);
  scaled.displacement = [=](double x) { return s * 0.04 * x * x; };
  scaled.velocity = [=](double x) { return -s * c * 2 * x; };
  scaled.lower = [=](double) { return -s * 0.1; };
  scaled.upper = [=](double) { return s * 0.1; };
  scaled.inertia *= m;
  scaled.stiffness *= m * c * c;
  SampleGrid times = grid;
  for (double& t : times.times) t /= c;
  const SampledMotion other = solved(scaled, times).motion;
  REQUIRE(other.events.size() == motion.events.size());
  // Events are isolated to 1e-12 of the displacement over the speed of the slowest impact, 0.17 m/s.
  for (std::size_t i = 0; i < motion.events.size(); ++i) {
    CHECK(std::abs(other.events[i].time * c - motion.events[i].time) < 1e-11);
    CHECK(other.events[i].velocity == Approx(s * c * motion.events[i].velocity).epsilon(1e-9));
  }
  for (std::size_t i = 0; i < motion.tip.size(); ++i) {
    CHECK(std::abs(other.tip[i] - s * motion.tip[i]) < s * 1e-11);
    CHECK(other.energy[i] == Approx(m * s * s * c * c * motion.energy[i]).epsilon(1e-9));
    CHECK(other.impulse[i] == Approx(m * s * c * motion.impulse[i]).epsilon(1e-9));
  }
}

TEST_CASE("a tip that starts on its stop") {
  ReferenceProblem problem = still_problem(1e-4);
  problem.lower = [](double) { return 0.0; };
  const double sign = GENERATE(-1.0, 1.0);
  problem.velocity = [=](double x) { return sign * x * x; };
  const SampledMotion motion = solved(problem, {spread(0.05, 100), {}, {}}).motion;
  if (sign < 0) {
    REQUIRE_FALSE(motion.events.empty());
    CHECK(motion.events[0].time == 0);
    CHECK(motion.events[0].velocity == Approx(-length * length));
    CHECK(motion.tip[1] == 0);
    CHECK(motion.impulse[1] > 0);
  } else {
    CHECK((motion.events.empty() || motion.events[0].time > 0.01));
    CHECK(motion.tip[1] > 0);
  }
}

TEST_CASE("what does not touch is linear: absent stops, absent law and stops out of reach agree") {
  const SampleGrid grid{spread(0.5, 10), {0.4, 1.1}, {}};
  ReferenceProblem out_of_reach = free_problem(1e-4), no_law = free_problem(1e-4), nowhere = free_problem(1e-4);
  out_of_reach.lower = [](double) { return -50.0; };
  out_of_reach.upper = [](double) { return 50.0; };
  no_law.contact_absent = true;
  nowhere.stops_at_tip = false;
  nowhere.stop_places = {};
  const SampledMotion expected = solved(without_stops(free_problem(1e-4)), grid).motion;
  CHECK(*std::max_element(expected.tip.begin(), expected.tip.end()) > 0.1);
  for (const ReferenceProblem& problem : {out_of_reach, no_law, nowhere}) {
    const SampledMotion motion = solved(problem, grid).motion;
    CHECK(motion.events.empty());
    for (std::size_t i = 0; i < expected.displacement.size(); ++i)
      CHECK(std::abs(motion.displacement[i] - expected.displacement[i]) < 1e-13);
  }
}

TEST_CASE("fields are those of the tip, and derive from each other") {
  // Three neighbouring places and times: w_xx and u_t by differences, of error 1e-6.
  const double d = 1e-3 * length, x = 1.1, t = 0.3, dt = 1e-5;
  const SampleGrid grid{{0, t - dt, t, t + dt}, {x - d, x, x + d, length * (1 - 1e-9)}, {}};
  for (const ReferenceProblem& problem : {free_problem(1e-4), forced_problem(0.06, 1e-4)}) {
    const SampledMotion motion = solved(problem, grid).motion;
    const auto u = [&](std::size_t time, std::size_t place) { return motion.displacement[4 * time + place]; };
    CHECK(motion.strain[4 * 2 + 1] == Approx((u(2, 0) - 2 * u(2, 1) + u(2, 2)) / (d * d)).epsilon(1e-4));
    CHECK(motion.velocity[4 * 2 + 1] == Approx((u(3, 1) - u(1, 1)) / (2 * dt)).epsilon(1e-4));
    for (std::size_t i = 1; i < 4; ++i) {
      CHECK(std::abs(u(i, 3) - motion.tip[i]) < 1e-8);
      CHECK(std::abs(motion.velocity[4 * i + 3] - motion.tip_velocity[i]) < 1e-6);
    }
    CHECK(u(0, 1) == problem.displacement(x));
  }
}

TEST_CASE("scenes without this reference are refused in a sentence") {
  using Catch::Contains;
  ReferenceProblem problem = free_problem(1e-4);
  problem.structure = "oscillator";
  CHECK_THAT(refused(problem), Contains("an oscillator"));
  problem = free_problem(1e-4);
  problem.right_fixed = true;
  CHECK_THAT(refused(problem), Contains("free at x = L"));
  problem = free_problem(1e-4);
  problem.other_beam = true;
  CHECK_THAT(refused(problem),
             Contains("supports, sections") && Contains("use `event-driven-semi-discrete` or `self`"));
  problem = free_problem(1e-4);
  problem.stops_at_tip = false;
  problem.stop_places = {0.5, length};
  CHECK_THAT(refused(problem), Contains("at the tip only"));
  problem.stop_places = {length};
  CHECK(refused(problem).empty());
  problem = free_problem(1e-4);
  problem.contact_stiffness = 1e6;
  CHECK_THAT(refused(problem), Contains("compliant"));
  problem.contact_stiffness = 0;
  problem.contact_nonlinear = true;
  CHECK_THAT(refused(problem), Contains("compliant"));
  CHECK(refused(without_stops(problem)).empty());
  problem = free_problem(1e-4);
  problem.load_zero = problem.load_constant = false;
  problem.load = [](double, double t) { return std::sin(t); };
  CHECK_THAT(refused(problem), Contains("depends on time"));
  problem = free_problem(1e-4);
  problem.displacement = [](double x) { return 0.2 * x * x; };
  CHECK_THAT(refused(problem), Contains("beyond its stops"));
  problem.displacement = [](double x) { return 0.01 * x; };
  CHECK_THAT(refused(problem), Contains("does not follow the clamp"));
  problem.displacement = [](double) { return std::nan(""); };
  CHECK_THAT(refused(problem), Contains("not a finite number"));
  problem = forced_problem(0.05, 0);
  problem.support_pulsation = first_pulsation(problem);
  CHECK_THAT(refused(problem), Contains("undamped mode 1 of the free beam"));
  problem.damping_mass = 0.1;
  CHECK(refused(problem).empty());
  CHECK_THAT(refused(free_problem(0), {{"events", 1LL}}), Contains("chatters"));
}

TEST_CASE("what a reader should know is noted") {
  ReferenceProblem problem = free_problem(1e-4);
  const SampleGrid grid{{0, 0.1}, {}, {}};
  problem.restitution = 0.5;
  problem.projected = true;
  const ReferenceMotion found = solved(problem, grid);
  CHECK(mentions(found.notes, "restitution 0.5"));
  CHECK(mentions(found.notes, "projection"));
  CHECK(found.how.find("80 clamped–free modes") != std::string::npos);
  CHECK(mentions(solved(forced_problem(1e-3, 1e-4), {{0, 0.01}, {}, {}}).notes, "support moves") == false);
  problem = forced_problem(1e-6, 1e-4);
  problem.support_pulsation = 3e5;
  CHECK(mentions(solved(problem, {{0, 0.01}, {}, {}}).notes, "raise `modes`"));
}
