// Stops in stages, stops with interference and stops of unlike sides at one place of a study, by closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "runners/store/record_values.hpp"
#include "tests/refusals.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

/// A spring that begins at a gap.
struct Spring {
  double gap, stiffness;
};

/// What a free mass that runs onto springs one after the other meets, in closed form: each stage is half a sine.
struct Stages {
  double depth = 0;  ///< where it turns, m
  std::vector<double> force, impulse, time;
};

// The mass moves by x = c + A sin(ωt) + B cos(ωt) between two springs, ω² = Σk/m, c = Σ k g / Σ k.
Stages run_onto(double mass, double speed, const std::vector<Spring>& springs) {
  Stages out;
  std::vector<double> spent(springs.size(), 0.0), pushed(springs.size(), 0.0);
  double at = springs.front().gap, v = speed;
  for (std::size_t n = 0; n < springs.size(); ++n) {
    double sum = 0, weighted = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      sum += springs[i].stiffness;
      weighted += springs[i].stiffness * springs[i].gap;
    }
    const double omega = std::sqrt(sum / mass), centre = weighted / sum, b = at - centre, a = v / omega;
    const double radius = std::hypot(a, b), phase = std::atan2(b, a);  // x = centre + radius sin(ωt + phase)
    const bool last = n + 1 == springs.size() || centre + radius <= springs[n + 1].gap;
    const double end = last ? std::acos(-1.0) / 2 : std::asin((springs[n + 1].gap - centre) / radius);
    const double lasts = (end - phase) / omega;
    for (std::size_t i = 0; i <= n; ++i) {
      spent[i] += lasts;
      pushed[i] += springs[i].stiffness *
                   ((centre - springs[i].gap) * lasts + radius / omega * (std::cos(phase) - std::cos(end)));
    }
    at = centre + radius * std::sin(end);
    v = radius * omega * std::cos(end);
    if (last) break;
  }
  out.depth = at;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    out.force.push_back(spent[i] > 0 ? springs[i].stiffness * (at - springs[i].gap) : 0.0);
    out.impulse.push_back(2 * pushed[i]);  // in and out
    out.time.push_back(2 * spent[i]);
  }
  return out;
}

Json carriage(double mass, double speed, const std::vector<Spring>& springs, double step, double duration) {
  Json study = Json::parse(R"json({
    "name": "carriage", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "stiffness": 0}, "stops": []},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e5, "evaluation": "averaged"},
                "time": {"name": "newmark-dumont-paoli", "beta": 0.25}},
    "samples": 100})json");
  study["scene"]["structure"]["mass"] = mass;
  study["scene"]["initial"]["velocity"] = speed;
  for (std::size_t i = 0; i < springs.size(); ++i)
    study["scene"]["stops"].push_back({{"name", fmt::format("s{}", i)},
                                       {"at", {{"x", 0}}},
                                       {"upper", springs[i].gap},
                                       {"stiffness", springs[i].stiffness}});
  study["step"] = step;
  study["duration"] = duration;
  return study;
}

double value(const CaseRecord& record, const std::string& name) {
  INFO(name << " of " << word(record.status) << " " << record.reason());
  const auto found = measure(record, name);
  REQUIRE(found.has_value());
  return *found;
}

}  // namespace

TEST_CASE("an end stop of two stages: travel, forces and impulses of the closed form") {
  const std::vector<Spring> springs = {{0.1, 2e4}, {0.12, 4e5}};
  const Stages exact = run_onto(50, 1.2, springs);
  CHECK(exact.depth - 0.1 == Approx(31.42857e-3).epsilon(1e-6));
  CHECK(exact.force[0] == Approx(628.571).epsilon(1e-6));
  CHECK(exact.force[1] == Approx(4571.43).epsilon(1e-6));
  CHECK(exact.impulse[0] == Approx(24.6684).epsilon(1e-5));
  CHECK(exact.impulse[1] == Approx(95.3316).epsilon(1e-5));
  Json study = carriage(50, 1.2, springs, 2e-5, 0.4);
  study["methods"]["time"] = Json::parse(
      R"([{"name": "newmark-dumont-paoli", "beta": 0.25}, {"name": "moreau-jean", "theta": 0.5}, "newmark"])");
  for (const CaseRecord& record : CaseRuns().of(study)) {
    INFO(record.id);
    REQUIRE(record.status == Status::done);
    // The forces are means over steps of 2e-5 s, whose angle is 2e-3 rad or less.
    CHECK(value(record, "deepest_penetration") == Approx(exact.depth - 0.1).epsilon(1e-4));
    CHECK(value(record, "peak_force[s0]") == Approx(exact.force[0]).epsilon(1e-3));
    CHECK(value(record, "peak_force[s1]") == Approx(exact.force[1]).epsilon(1e-3));
    CHECK(value(record, "impulse[s0]") == Approx(exact.impulse[0]).epsilon(1e-4));
    CHECK(value(record, "impulse[s1]") == Approx(exact.impulse[1]).epsilon(1e-4));
    CHECK(value(record, "impulse") == Approx(2 * 50 * 1.2).epsilon(1e-6));
    CHECK(value(record, "impacts[s0]") == 1);
    CHECK(value(record, "impacts[s1]") == 1);
  }
}

TEST_CASE("springs at one place with gaps of their own are one spring in pieces") {
  std::mt19937 draw(20261128);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(draw()) / static_cast<double>(std::mt19937::max());
  };
  for (int scene = 0; scene < 6; ++scene) {
    std::vector<Spring> springs;
    double gap = 0.02;
    for (int i = 0; i < 2 + scene % 3; ++i) {
      springs.push_back({gap, std::pow(10.0, between(3, 5))});
      gap += between(0.002, 0.01);
    }
    const double mass = between(0.5, 5), speed = between(0.8, 2);
    const Stages exact = run_onto(mass, speed, springs);
    const double duration = 0.02 / speed + 1.05 * exact.time.front(), step = duration / 20000;
    const CaseRecord record = CaseRuns().first_of(carriage(mass, speed, springs, step, 20000 * step));
    INFO(scene << ": " << record.reason());
    REQUIRE(record.status == Status::done);
    CHECK(value(record, "deepest_penetration") == Approx(exact.depth - springs.front().gap).epsilon(1e-4));
    for (std::size_t i = 0; i < springs.size(); ++i) {
      const std::string of = fmt::format("[s{}]", i);
      // A contact is known to a step or two at each end.
      CHECK(value(record, "contact_time" + of) == Approx(exact.time[i]).margin(4 * step));
      CHECK(value(record, "impulse" + of) == Approx(exact.impulse[i]).epsilon(1e-3).margin(1e-4));
      CHECK(value(record, "peak_force" + of) == Approx(exact.force[i]).epsilon(2e-3).margin(1e-3));
    }
  }
}

TEST_CASE("a rod held with interference between two springs, in contact and as one of them opens") {
  Json study = Json::parse(R"json({
    "name": "grip", "kind": "trajectory",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1e4},
              "stops": [{"name": "grip", "at": {"x": 0}, "lower": 1e-4, "upper": -1e-4}],
              "initial": {"velocity": 0.02}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e5, "evaluation": "averaged"},
                "time": [{"name": "newmark-dumont-paoli", "beta": 0.25}, {"name": "moreau-jean", "theta": 0.5}]},
    "step": 5e-6, "duration": 0.05, "samples": 500})json");
  const auto apart = [](Json one) {
    one["scene"]["stops"] = Json::parse(R"([{"name": "below", "at": {"x": 0}, "lower": 1e-4},
                                            {"name": "above", "at": {"x": 0}, "upper": -1e-4}])");
    return one;
  };
  const double omega = std::sqrt(1e4 + 2e5);
  for (const Json& one : {study, apart(study)})
    for (const CaseRecord& record : CaseRuns().of(one)) {
      INFO(record.id);
      REQUIRE(record.status == Status::done);
      CHECK(value(record, "largest_tip_displacement") == Approx(0.02 / omega).epsilon(1e-5));  // 4.36436e-5 m
      // The angle of a step is 2.3e-3: after 0.05 s its error, ω³h²t/12, is 1e-5 of a radian.
      CHECK(value(record, "tip_displacement_end") == Approx(-3.47686e-5).epsilon(1e-4));
      CHECK(value(record, "impacts") == 0);
    }
  // At 0.1 m/s one spring opens at 1e-4 m, after asin(1e-4 ω/0.1)/ω; then k + κ pulls, from where κ·1e-4 is its force.
  study["scene"]["initial"]["velocity"] = 0.1;
  const double opens = std::asin(1e-4 * omega / 0.1) / omega, slow = std::sqrt(1.1e5), centre = -10 / 1.1e5;
  CHECK(opens == Approx(1.03879e-3).epsilon(1e-5));
  const double speed = 0.1 * std::cos(omega * opens), most = centre + std::hypot(1e-4 - centre, speed / slow);
  CHECK(most == Approx(2.381266e-4).epsilon(1e-6));
  for (const Json& one : {study, apart(study)})
    for (const CaseRecord& record : CaseRuns().of(one)) {
      REQUIRE(record.status == Status::done);
      CHECK(value(record, "largest_tip_displacement") == Approx(most).epsilon(1e-4));
    }
}

TEST_CASE("rigid laws refuse interference and equal bounds case by case, and compliant ones run beside them") {
  Json study = carriage(1, 1, {{0.1, 1e4}, {0.1, 2e4}}, 1e-4, 0.2);
  study["methods"]["contact"] = Json::parse(R"(["signorini", {"name": "penalty", "stiffness": 1e5}])");
  std::vector<CaseRecord> records = CaseRuns().of(study);
  REQUIRE(records.size() == 2);
  CHECK(records[0].status == Status::refused);
  CHECK_THAT(records[0].reason(), Contains("rigid law knows only the sum of their forces") && names_cause_and_remedy());
  CHECK(records[1].status == Status::done);
  study["scene"]["stops"] = Json::parse(R"([{"name": "grip", "at": {"x": 0}, "lower": 1e-4, "upper": -1e-4}])");
  records = CaseRuns().of(study);
  CHECK(records[0].status == Status::refused);
  CHECK_THAT(records[0].reason(), Contains("Expected lower ≤ upper, or a compliant law that lets points pass both"));
  CHECK(records[1].status == Status::done);
  study["methods"]["contact"] = "signorini";
  CHECK_THAT(CaseRuns().refusal(study), Contains("/scene/stops/0/lower: stop grip: lower 0.0001 m > upper -0.0001 m"));
}

TEST_CASE("the stop of two that a rigid law never meets is told, and has no contact") {
  Json study = carriage(1, 1, {{0.1, 1e4}, {0.12, 2e4}}, 1e-4, 0.3);
  study["methods"]["contact"] = "signorini";
  study["methods"]["time"] = {{"name", "moreau-jean"}, {"restitution", 0.5}};
  const CaseRecord record = CaseRuns().first_of(study);
  REQUIRE(record.status == Status::done);
  CHECK(value(record, "impulse[s0]") == Approx(1.5).epsilon(1e-9));
  CHECK(value(record, "impulse[s1]") == 0);
  CHECK(record.reason().empty());
  CHECK(std::find(record.notes.begin(), record.notes.end(),
                  "stop s1: a rigid law never meets its upper bound, behind that of s0 at one place") !=
        record.notes.end());
}

TEST_CASE("an oscillator's load may say its one place, and an empty list is no stop") {
  Json study = carriage(2, 0, {{0.1, 1e4}}, 1e-3, 0.1);
  const auto end = [&](const Json& load, const Json& stops) {
    study["scene"]["load"] = load;
    study["scene"]["stops"] = stops;
    return value(CaseRuns().first_of(study), "tip_displacement_end");
  };
  const Json stops = study["scene"]["stops"];
  const double plain = end(Json::parse(R"([{"force": "3"}])"), stops);
  CHECK(plain == Approx(0.5 * 1.5 * 0.01).epsilon(1e-9));
  CHECK(end(Json::parse(R"([{"at": {"x": 0}, "force": "3"}])"), stops) == plain);
  CHECK(end(Json::parse(R"([{"at": 0, "force": "3"}])"), stops) == plain);
  CHECK(end(Json::parse(R"([{"at": 0, "force": "3"}])"), Json::array()) == plain);
  study["scene"]["load"] = Json::parse(R"([{"at": {"x": 0.5}, "force": "3"}])");
  CHECK_THAT(CaseRuns().refusal(study), Contains("/scene/load/0/at: an oscillator has one point, x = 0"));
  // The same cases as without the key.
  study["scene"]["load"] = "3";
  study["scene"]["stops"] = Json::array();
  const std::string id = CaseRuns().study(study).cases.front().id;
  study["scene"].erase("stops");
  CHECK(CaseRuns().study(study).cases.front().id == id);
}
