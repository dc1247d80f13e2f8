// A forecast is measured on this machine: laws of it, and no figure.
#include "runners/run/forecast.hpp"

#include <catch2/catch.hpp>
#include <ricochet/loader/catalogue.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/march/march_pace.hpp"
#include "runners/study/load_study.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

Json swinging_beam(const std::string& kind) {
  return Json::parse(R"({
    "name": "forecast", "kind": ")" +
                     kind + R"(",
    "scene": {"structure": {"type": "beam", "length": 1.5, "section": {"type": "given", "EI": 33.8, "rhoS": 0.12},
                            "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "nodes"},
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": [4, 8]},
    "methods": {"mass": ["consistent", "singular"], "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": [1e-4, 5e-5], "duration": 0.2})");
}

struct Planned {
  Catalogue catalogue{RICOCHET_PLUGIN_DIR, {}, {}};
  Registry registry;
  Study study;
  std::vector<PlannedCase> cases;

  explicit Planned(const Json& json) {
    const ScratchFolder folder;
    write_text(folder / "study.json", json.dump());
    study = load_study(folder / "study.json", catalogue, registry);
    CasePlanner planner(study, catalogue, registry);
    for (const StudyCase& one : study.cases) cases.push_back({&one, planner.plan(one).plan});
  }
  Forecast forecast() {
    const CasePlanner planner(study, catalogue, registry);
    return ricochet::forecast(study, cases, planner, registry);
  }
};

}  // namespace

TEST_CASE("forecast: a part of every case of a small study is marched, and all cost something") {
  Planned planned(swinging_beam("trajectory"));
  const Forecast found = planned.forecast();
  CHECK(found.measured == 8);
  CHECK(found.longest > 0);
  CHECK(found.seconds > found.longest);
  for (const PlannedCase& one : planned.cases) CHECK(one.plan.predicted_seconds > 0);
}

TEST_CASE("forecast: a hundred times the repeats cost more than the noise of a machine") {
  Json few = swinging_beam("work-precision"), many = few;
  few["reference"] = many["reference"] = "self";
  few["repeats"] = 3;
  many["repeats"] = 1000;
  CHECK(Planned(many).forecast().seconds > 10 * Planned(few).forecast().seconds);
}

TEST_CASE("forecast: a reference that is marched on finer steps is counted once for all that share it") {
  Json study = swinging_beam("convergence");
  study["reference"] = "self";
  Planned planned(study);
  const Kind& kind = *find_kind("convergence");
  ForecastContext context{planned.study, planned.registry, {}, [](const StudyCase&) { return 1.0; }};
  for (const StudyCase& one : planned.study.cases) context.cases.push_back(&one);
  const double all = kind.beside(context);
  // h/4 and h/8 of the smallest step on twice the finest mesh, h/4 on the finest, once for each mass and mesh; two
  // twins for each mesh. A step costs what its elements do: (12·2 + 4)·4000 steps of 8 elements and of 4 for each mass.
  const double marched = 2 * (28.0 * 4000 + 2 * 28.0 * 4000), twins = 2 * 2 * 2000;
  const double rest = all - marched - twins;
  CHECK(rest >= 0);
  CHECK(rest < 1);  // samples
}

TEST_CASE("a pace is that of the case, whatever its step: what is refused has none") {
  Planned planned(swinging_beam("trajectory"));
  for (const PlannedCase& one : planned.cases) CHECK(march_pace(*one.study_case, planned.registry).value_or(0) > 0);
  Json impossible = swinging_beam("trajectory");
  impossible["methods"]["mass"] = "singular";
  impossible["methods"]["time"] = {{"name", "moreau-jean"}, {"theta", 0.5}};
  Planned refused(impossible);
  CHECK_FALSE(march_pace(*refused.cases.front().study_case, refused.registry));
}
