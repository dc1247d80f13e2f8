// Runs of bodies: one body as the structure that it is, two as one, and stops with a motion of their own.
#include <catch2/catch.hpp>

#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json thrown_beam() {
  return Json::parse(R"json({
    "name": "thrown", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005},
                            "damping": {"stiffness": 1e-5}},
              "stops": [{"name": "end", "at": {"x": 1.5}, "lower": -0.1, "upper": 0.1}],
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": [6, 12]},
    "methods": {"mass": ["consistent", "singular"], "contact": ["signorini", {"name": "penalty", "stiffness": 1e5}],
                "time": "newmark-dumont-paoli"},
    "step": 1e-4, "duration": 0.2, "samples": 100})json");
}

Json driven_pair() {
  return Json::parse(R"json({
    "name": "pair", "kind": "trajectory",
    "scene": {"bodies": {"rod": {"type": "beam", "length": 0.5, "section": {"type": "given", "EI": 14.4, "rhoS": 0.6}},
                         "ball": {"type": "oscillator", "mass": 0.1, "stiffness": 4e4}},
              "stops": [{"name": "gap", "at": {"body": "rod", "x": 0.5}, "to": {"body": "ball"}, "upper": 1e-4}],
              "load": [{"at": {"body": "rod", "x": 0.5}, "force": "sin(100*t)"}],
              "points": [{"name": "rod-end", "at": {"body": "rod", "x": 0.5}}, {"name": "ball", "at": {"body": "ball"}}]},
    "mesh": {"elements": [{"rod": 4}, {"rod": 8}]},
    "methods": {"mass": ["consistent", "singular"], "contact": ["signorini", {"name": "penalty", "stiffness": 1e6}],
                "time": "newmark-dumont-paoli"},
    "step": 1e-5, "duration": 0.1, "samples": 100})json");
}

double measured(const CaseRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.measures)
    if (key == name) return value;
  return 0;
}

}  // namespace

TEST_CASE("a beam written as one body runs as the structure, bit for bit") {
  Json one = thrown_beam(), body = thrown_beam();
  body["scene"]["bodies"]["tube"] = body["scene"]["structure"];
  body["scene"].erase("structure");
  body["scene"]["stops"][0]["at"]["body"] = "tube";
  CaseRuns runs;
  const std::vector<CaseRecord> a = runs.of(one), b = runs.of(body);
  REQUIRE(a.size() == 8);
  REQUIRE(b.size() == 8);
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].status == Status::done);
    REQUIRE(a[i].measures.size() == b[i].measures.size());
    for (std::size_t k = 0; k < a[i].measures.size(); ++k) {
      const auto& [name, value] = a[i].measures[k];
      INFO(name);
      CHECK(b[i].measures[k].first == name);
      if (name.find("second") == std::string::npos) CHECK(b[i].measures[k].second == value);
    }
  }
}

TEST_CASE("a rod and a ball run, each mesh by the numbers of its bodies") {
  CaseRuns runs;
  const std::vector<CaseRecord> records = runs.of(driven_pair());
  REQUIRE(records.size() == 8);
  for (const CaseRecord& record : records) {
    INFO(record.reason());
    CHECK(record.status == Status::done);
    CHECK(measured(record, "impulse[gap]") > 0);
  }
}

TEST_CASE("a study of bodies refuses what one of them refuses, by its name") {
  Json study = driven_pair();
  study["methods"]["mass"] = "mass-scaling";
  study["scene"]["bodies"]["frame"] = {{"type", "beam"},
                                       {"length", 1},
                                       {"section", {{"type", "given"}, {"EI", 1}, {"rhoS", 1}}},
                                       {"supports", Json::array()}};
  study["mesh"]["elements"] = 4;
  CaseRuns runs;
  for (const CaseRecord& record : runs.of(study))
    if (record.status == Status::refused) CHECK_THAT(record.reason(), Catch::StartsWith("body "));
}
