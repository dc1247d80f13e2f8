// What several threads plan is what one plans.
#include "runners/run/plan_cases.hpp"

#include <fmt/format.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <ricochet/contract/errors.hpp>

#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

struct Planner {
  Catalogue catalogue{tests::places().plugins, {}, {}};
  Registry registry;
  Study study;

  explicit Planner(const Json& displacements) {
    Json json = Json::parse(R"({
      "name": "planned", "kind": "trajectory",
      "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 100, "force": {"amplitude": [1, 2], "pulsation": 3}},
                "stops": {"lower": -1, "upper": 1, "at": "tip"}, "initial": {}},
      "methods": {"mass": "consistent", "contact": ["signorini", {"name": "penalty", "stiffness": 1e4}],
                  "time": ["moreau-jean", "central-difference", "newmark"]},
      "exclude": [{"contact": "penalty", "time": "newmark", "why": "elsewhere"}],
      "step": [0.01, 0.3], "duration": 6})");
    json["scene"]["initial"]["displacement"] = displacements;
    const ScratchFolder folder;
    write_text(folder / "study.json", json.dump());
    study = load_study(folder / "study.json", catalogue, registry);
  }
  std::vector<PlanOutcome> all(int at_once) {
    most = 0;
    return CasePlanner(study, catalogue, registry).plan_all(study.cases, at_once, [&](std::size_t done) {
      most = std::max(most.load(), done);
    });
  }
  std::atomic<std::size_t> most{0};
};

}  // namespace

TEST_CASE("plan cases: several threads give what each case gives alone, in their order") {
  Planner planner(Json{0.0, 0.5, 1.5});
  CasePlanner one_by_one(planner.study, planner.catalogue, planner.registry);
  for (const int at_once : {1, 4}) {
    const std::vector<PlanOutcome> all = planner.all(at_once);
    REQUIRE(all.size() == planner.study.cases.size());
    std::size_t excluded = 0, refused = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const StudyCase& one = planner.study.cases[i];
      if (one.excluded) {
        ++excluded;
        CHECK(all[i].plan.operator_name.empty());
        continue;
      }
      const PlanOutcome alone = one_by_one.plan(one);
      refused += alone.plan.refusal.empty() ? 0 : 1;
      CHECK(all[i].plan.refusal == alone.plan.refusal);
      CHECK(all[i].plan.notes == alone.plan.notes);
      CHECK(all[i].plan.steps == alone.plan.steps);
      CHECK(all[i].failure == alone.failure);
    }
    CHECK(excluded > 0);
    CHECK(refused > 0);
    CHECK(planner.most == all.size() - excluded);
  }
}

TEST_CASE("plan cases: of several wrong cases the first is told") {
  Planner planner(0.5);
  PluginManual manual;
  manual.name = "wrong";
  manual.summary = "Throws.";
  planner.registry.add_time(manual, [](const Parameters&, double h, const ProblemFacts&) -> PlanOrRefusal {
    throw InputError("/step", fmt::format("the step {}", h));
  });
  for (const std::size_t i : {3U, 4U, 6U}) {
    planner.study.cases[i].excluded.reset();
    planner.study.cases[i].time = {"wrong", {}};
    planner.study.cases[i].step = static_cast<double>(i);
  }
  for (int k = 0; k < 20; ++k) CHECK_THROWS_WITH(planner.all(4), Catch::Contains("the step 3"));
}
