// What a trajectory says of steps that are too long for its load or for its gap.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "runners/store/record_values.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

/// A mass of 1 kg between two stops, at 1 m/s.
Json thrown(double gap, double step, const Json& law) {
  Json study = Json::parse(R"({
    "name": "thrown", "kind": "trajectory",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 0},
      "stops": {"at": "tip"},
      "initial": {"velocity": "1"}
    },
    "methods": {"mass": "consistent", "time": {"name": "moreau-jean", "restitution": 1}},
    "samples": 10
  })");
  study["scene"]["stops"]["lower"] = -gap / 2;
  study["scene"]["stops"]["upper"] = gap / 2;
  study["methods"]["contact"] = law;
  study["step"] = step;
  study["duration"] = 50 * step;
  return study;
}

const Json rigid = "signorini", soft = {{"name", "penalty"}, {"stiffness", 100}};

}  // namespace

TEST_CASE("a step that is longer than the way from stop to stop is told") {
  const CaseRecord fine = CaseRuns().first_of(thrown(0.1, 1e-3, rigid));
  CHECK(fine.status == Status::done);
  CHECK(fine.reason().empty());
  const CaseRecord coarse = CaseRuns().first_of(thrown(1e-3, 1e-2, rigid));
  CHECK(coarse.status == Status::done);
  CHECK_THAT(coarse.reason(),
             Contains("a step of 0.01 s takes a point further than the gap, 10 times as far, first at t"));
  // One stop has no gap, nor have two that meet.
  Json one = thrown(1e-3, 1e-2, rigid);
  one["scene"]["stops"]["lower"] = nullptr;
  CHECK(CaseRuns().first_of(one).reason().empty());
  Json meeting = thrown(1e-3, 1e-2, rigid);
  meeting["scene"]["stops"]["lower"] = meeting["scene"]["stops"]["upper"] = 0;
  CHECK(CaseRuns().first_of(meeting).reason().empty());
}

TEST_CASE("a point that goes deeper than a measured table knows is told") {
  // Of k = 100 N/m it turns 0.1 m beyond the stop.
  const auto told = [](double end) {
    const Json table = {{"name", "table"}, {"depth_force", {{0, 0}, {end / 2, 50 * end}, {end, 100 * end}}}};
    return CaseRuns().first_of(thrown(1, 2e-2, table));
  };
  CHECK(told(0.2).reason().empty());
  const CaseRecord beyond = told(0.05);
  CHECK(beyond.status == Status::done);
  CHECK_THAT(beyond.reason(), Contains("depth_force ends at 0.05 m: its last slope is taken beyond"));
}

TEST_CASE("a point that is further beyond its stop than the gap is wide is told") {
  // It turns v √(m/k) = 0.1 m beyond the stop.
  const auto told = [](double gap, double step) { return CaseRuns().first_of(thrown(gap, step, soft)).reason(); };
  CHECK(told(0.2, 1e-3).empty());
  // Two gaps are those of a soft stop, twenty of one that is none.
  CHECK(told(0.02, 1e-3).empty());
  CHECK_THAT(told(0.002, 1e-3),
             Contains("a point passes its stop by more than the gap, up to ") && !Contains("a step of"));
  Json damped = thrown(0.002, 1e-3, soft);
  damped["duration"] = 1;
  damped["step"] = 1e-3;
  const CaseRecord turned = CaseRuns().first_of(damped);
  const double deepest = measure(turned, "deepest_penetration").value();
  CHECK(deepest == Approx(0.1).epsilon(0.01));  // fifty gaps; the implicit law loses a share of the order of ωh
  CHECK_THAT(turned.reason(), Contains(fmt::format("up to {:.3g} times, first at t = 0.0", deepest / 0.002)));
}

TEST_CASE("a load that no step sees is told, and a case that fails keeps it as a note") {
  Json study = thrown(0.1, 1e-3, rigid);
  study["scene"]["load"] = Json::array({{{"force", "t > 0.0101 && t < 0.0102 ? 1 : 0"}}});
  const CaseRecord done = CaseRuns().first_of(study);
  CHECK_THAT(done.reason(), Contains("the load comes and goes within a step of 0.001 s, at t = 0.0101"));
  study["budget"] = 1e-12;
  study["duration"] = 1000;
  const CaseRecord failed = CaseRuns().first_of(study);
  CHECK(failed.status == Status::failed);
  CHECK_THAT(failed.reason(), Contains("budget") && !Contains("comes and goes"));
  CHECK(std::any_of(failed.notes.begin(), failed.notes.end(),
                    [](const std::string& note) { return note.find("comes and goes") != std::string::npos; }));
}

namespace {

/// Balls of 1 kg in a row, `gap` apart, the first thrown at 1 m/s.
Json cradle(int balls, double gap, double restitution, const Json& law) {
  Json study = Json::parse(R"json({
    "name": "cradle", "kind": "trajectory",
    "scene": {"initial": {"b0": {"velocity": 1}}},
    "methods": {"mass": "consistent", "time": [{"name": "moreau-jean"}, {"name": "newmark-dumont-paoli", "beta": 0.5}]},
    "step": 1e-4, "duration": 0.1, "samples": 10})json");
  for (int i = 0; i < balls; ++i) {
    study["scene"]["bodies"][fmt::format("b{}", i)] = {{"type", "oscillator"}, {"mass", 1}, {"stiffness", 0}};
    if (i > 0)
      study["scene"]["stops"].push_back({{"name", fmt::format("s{}", i)},
                                         {"at", {{"body", fmt::format("b{}", i - 1)}}},
                                         {"to", {{"body", fmt::format("b{}", i)}}},
                                         {"upper", gap}});
  }
  for (Json& time : study["methods"]["time"]) time["restitution"] = restitution;
  study["methods"]["contact"] = law;
  return study;
}

/// What the cases of a study say of themselves, each once.
std::set<std::string> reasons(const Json& study) {
  std::set<std::string> out;
  for (const CaseRecord& record : CaseRuns().of(study)) {
    CHECK(record.status == Status::done);
    out.insert(record.reason());
  }
  return out;
}

std::set<std::string> struck(int contacts) {
  return {fmt::format("{} contacts were struck in one step: rigid laws choose among outcomes, first at t = 0.0001 s",
                      contacts)};
}

}  // namespace

TEST_CASE("contacts that one step strikes together are told where their outcome is the law's choice") {
  CHECK(reasons(cradle(5, 0, 1, rigid)) == struck(4));
  CHECK(reasons(cradle(3, 0, 0.5, rigid)) == struck(2));
  // Without restitution the balls go on together, one after the other or at once.
  CHECK(reasons(cradle(4, 0, 0, rigid)) == std::set<std::string>{""});
  // One after the other.
  CHECK(reasons(cradle(4, 1e-3, 1, rigid)) == std::set<std::string>{""});
  // Springs decide by themselves.
  CHECK(reasons(cradle(4, 0, 1, {{"name", "penalty"}, {"stiffness", 1e6}})) == std::set<std::string>{""});
  // Two contacts at once that do not know of each other.
  Json apart = cradle(3, 0, 1, rigid);
  apart["scene"]["bodies"]["b3"] = apart["scene"]["bodies"]["b0"];
  apart["scene"]["stops"] = Json::parse(R"([{"name": "a", "at": {"body": "b0"}, "to": {"body": "b1"}, "upper": 0},
                                            {"name": "b", "at": {"body": "b2"}, "to": {"body": "b3"}, "upper": 0}])");
  apart["scene"]["initial"]["b2"] = {{"velocity", 1}};
  CHECK(reasons(apart) == std::set<std::string>{""});
}
