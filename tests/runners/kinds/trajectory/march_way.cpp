// Steps that a trajectory leaves out: its rows, its curve and its window are those of the integration of every step.
#include <catch2/catch.hpp>

#include "runners/store/record_values.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Json shaken_study() {
  return Json::parse(R"({
    "name": "shaken", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 300, "rhoS": 1},
                            "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.02, "upper": 0.02, "at": "nodes"},
              "support": {"amplitude": 0.015, "pulsation": 20}},
    "mesh": {"elements": 6},
    "methods": {"mass": {"name": "singular", "velocity": "P1"}, "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 1e-5, "duration": 0.5, "samples": 50, "snapshots": 20, "window": {"from": 0.1, "to": 0.4},
    "march": ["every-step", "flights"]})");
}

}  // namespace

TEST_CASE("a trajectory that leaves out steps has the measures, the curve and the impacts of one that marches them") {
  const std::vector<CaseRecord> records = CaseRuns().of(shaken_study());
  REQUIRE(records.size() == 2);
  const CaseRecord &every = records[0], &flown = records[1];
  REQUIRE(every.status == Status::done);
  REQUIRE(flown.status == Status::done);
  CHECK(axis(flown, "march").text() == "flights");
  CHECK(measure(every, "steps_visited").value() == Approx(50000).margin(1));
  CHECK(measure(flown, "steps_visited").value() < 10000);
  for (const auto& [name, value] : every.measures) {
    INFO(name);
    // What is of round-off's size, and what tells of the computation.
    if (name == "steps_visited" || name == "microseconds_per_step" || name == "balance_residual" ||
        name == "largest_step_gain" || name == "deepest_penetration" || name == "law_iterations" ||
        name == "complementarity_residual" || name == "energy_start" || name == "scheme_energy_start")
      continue;
    REQUIRE(measure(flown, name));
    CHECK(*measure(flown, name) == Approx(*measure(every, name)).epsilon(1e-6).margin(1e-12));
  }
  REQUIRE(flown.curve.columns.size() == every.curve.columns.size());
  for (std::size_t c = 0; c < every.curve.columns.size(); ++c) {
    const std::vector<double>&a = every.curve.columns[c], &b = flown.curve.columns[c];
    INFO(every.curve.names[c]);
    REQUIRE(a.size() == b.size());
    double largest = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest = std::max(largest, std::abs(a[i]));
      apart = std::max(apart, std::abs(a[i] - b[i]));
    }
    // A velocity over one step has its round-off over h.
    CHECK(apart <= 1e-5 * largest + 1e-12);
  }
}

TEST_CASE("how an integration goes is an axis of the study, and absent it is chosen case by case") {
  CaseRuns shaken;
  Json text = shaken_study();
  const Study two = shaken.study(text);
  CHECK(std::find(two.columns.begin(), two.columns.end(), "march") != two.columns.end());
  CHECK(two.cases[0].id != two.cases[1].id);
  text["exclude"] = Json::array({{{"march", "flights"}, {"why", "every step shall be seen"}}});
  CHECK(shaken.study(text).cases[1].excluded == "every step shall be seen");
  text.erase("exclude");
  text.erase("march");
  const Study one = shaken.study(text);
  CHECK(std::find(one.columns.begin(), one.columns.end(), "march") == one.columns.end());
  REQUIRE(one.cases.size() == 1);
  CHECK(one.cases[0].march == "auto");
  const CaseRecord chosen = shaken.of(text).front();
  CHECK(measure(chosen, "steps_visited").value() < 10000);
}

TEST_CASE("an integration by flights that cannot fly is refused with the reason, and one that may choose marches") {
  CaseRuns shaken;
  Json text = shaken_study();
  text["scene"]["load"] = "0.1*sin(3*t)";
  const std::vector<CaseRecord> records = shaken.of(text);
  CHECK(records[0].status == Status::done);
  CHECK(records[1].status == Status::refused);
  CHECK_THAT(records[1].reason(), Catch::Contains("the load depends on time") && Catch::Contains("march every step"));
  text["march"] = "auto";
  const CaseRecord chosen = shaken.of(text).front();
  CHECK(chosen.status == Status::done);
  CHECK_THAT(chosen.notes.back(), Catch::Contains("every step is marched") || Catch::Contains("Delassus"));
  text["march"] = "fly";
  CHECK_THAT(shaken.refusal(text), Catch::Contains("/march") && Catch::Contains("every-step"));
  text["march"] = 3;
  CHECK_THAT(shaken.refusal(text), Catch::Contains("/march"));
}

TEST_CASE("means over the parts of a window are those of every step, rigid stops and springs alike") {
  Json text = shaken_study();
  text["window"]["parts"] = 12;
  text["methods"]["contact"] = GENERATE(Json("signorini"), Json{{"name", "penalty"}, {"stiffness", 1e5}});
  text["methods"]["mass"] = "consistent";
  const std::vector<CaseRecord> records = CaseRuns().of(text);
  REQUIRE(records.size() == 2);
  CHECK(measure(records[1], "steps_visited").value() < 25000);
  for (const char* name : {"window_power", "window_force", "window_impact_rate", "window_tip_rms"})
    for (const std::string prefix : {"", "confidence."}) {
      INFO(prefix << name);
      const double every = measure(records[0], prefix + name).value();
      CHECK(measure(records[1], prefix + name).value() == Approx(every).epsilon(1e-6).margin(1e-12));
    }
}

TEST_CASE("steps whose energy has to be read are not left out of a trajectory, and the reason is told") {
  Json text = shaken_study();
  text["methods"] = Json::parse(R"({"mass": "lumped", "contact": "signorini", "time": "bathe"})");
  text["march"] = "flights";
  CaseRuns shaken;
  const CaseRecord refused = shaken.of(text).front();
  CHECK(refused.status == Status::refused);
  CHECK(refused.reason().find("the time scheme has no energy of its own") != std::string::npos);
  text["march"] = "auto";
  text["step"] = 1e-6;
  const CaseRecord marched = shaken.of(text).front();
  REQUIRE(marched.status == Status::done);
  CHECK(measure(marched, "steps_visited").value() == Approx(500000).margin(1));
  CHECK(std::any_of(marched.notes.begin(), marched.notes.end(), [](const std::string& note) {
    return note.starts_with("every step is marched: the time scheme has no energy of its own");
  }));
}
