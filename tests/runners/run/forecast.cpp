// Laws of a forecast, and no figure: machines differ.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <functional>
#include <ricochet/loader/catalogue.hpp>
#include <vector>

#include "runners/kinds/kind.hpp"
#include "runners/run/plan_cases.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/run/fake_study.hpp"
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
  Catalogue catalogue{tests::places().plugins, {}, {}};
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
  Forecast forecast() { return ricochet::forecast(study, cases, registry); }
};

}  // namespace

TEST_CASE("forecast: every case costs something, and the chain is a part of all") {
  Planned planned(swinging_beam("trajectory"));
  const Forecast found = planned.forecast();
  CHECK(found.chain > 0);
  CHECK(found.seconds > found.chain);
  for (const PlannedCase& one : planned.cases) CHECK(one.plan.predicted_seconds > 0);
}

TEST_CASE("forecast: several processors shorten neither one case nor what a run takes by itself") {
  Json one = swinging_beam("trajectory");
  one["mesh"]["elements"] = 4;
  one["methods"]["mass"] = "consistent";
  one["step"] = 5e-5;
  const Forecast alone = Planned(one).forecast();
  for (const int processors : {1, 2, 64}) CHECK(alone.on(processors) == Approx(alone.seconds));
  const Forecast many = Planned(swinging_beam("trajectory")).forecast();
  CHECK(many.on(1) == Approx(many.seconds));
  CHECK(many.on(2) < many.seconds);
  CHECK(many.on(1000) == Approx(many.fixed + many.chain));
}

TEST_CASE("forecast: what is stored costs as well") {
  Json few = swinging_beam("trajectory"), many = few;
  few["samples"] = 10;
  many["samples"] = 100000;
  CHECK(Planned(many).forecast().seconds > 2 * Planned(few).forecast().seconds);
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
  // h/4 and h/8 of the smallest step on twice the finest mesh, h/4 on the finest, once for each mass and mesh. Two
  // twins for each mesh. A step costs what its elements do: for each mass (12·2 + 4)·4000 steps of 8 elements, and
  // twice as many of 4.
  const double marched = 2 * (28.0 * 4000 + 2 * 28.0 * 4000), twins = 2 * 2 * 2000;
  const double rest = all - marched - twins;
  CHECK(rest >= 0);
  CHECK(rest < 1);  // samples
}

TEST_CASE("forecast: a reference that is solved costs what solving it takes, and not a second") {
  Json study = Json::parse(R"({
    "name": "forecast", "kind": "convergence",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 4}, "stops": {"upper": 0.7, "at": "tip"},
              "initial": {"displacement": 0.5, "velocity": 1}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": 1e-2, "duration": 2, "samples": 20, "reference": "exact"})");
  Planned planned(study);
  ForecastContext context{planned.study, planned.registry, {}, [](const StudyCase&) { return 0.0; }};
  for (const StudyCase& one : planned.study.cases) context.cases.push_back(&one);
  const double seconds = find_kind("convergence")->beside(context);
  CHECK(seconds > 0);
  CHECK(seconds < 0.5);
}

namespace {

/// What the one case of a study takes of a processor, over what its plan predicts: the least of three runs, which other
/// programs disturb the least.
double taken_over_predicted(const Json& study) {
  Planned planned(study);
  REQUIRE(planned.study.cases.size() == 1);
  const StudyCase& one = planned.study.cases.front();
  double least = 1e300;
  for (int run = 0; run < 3; ++run) {
    const CaseRunner runner =
        find_kind(planned.study.kind)->start({planned.study, planned.registry, [](const StudyCase&) { return ""; }});
    const std::atomic<bool> stop = false;
    if (runner.open) runner.open({}, stop);
    const CaseRecord record = runner.run(one, stop);
    least = std::min(least, record.setup_seconds + record.run_seconds);
  }
  return least / planned.cases.front().plan.predicted_seconds;
}

}  // namespace

TEST_CASE("forecast: a sweep and a range of steps take what their plans predict, as a trajectory does") {
  Json sweep = Json::parse(R"({
    "name": "sweep", "kind": "bifurcation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.2,
                            "force": {"amplitude": 1, "pulsation": 2.2}}, "stops": {"upper": 0.1, "at": "tip"}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "restitution": 0.5}},
    "parameter": {"pointer": "/scene/structure/force/pulsation", "from": 2, "to": 3, "count": 24},
    "steps_per_period": 400, "start": ["rest"], "transient": {"periods": 60, "at_most": 200}, "keep": 20})");
  Json trajectory = swinging_beam("trajectory");
  trajectory["mesh"]["elements"] = 6;
  trajectory["methods"]["mass"] = "consistent";
  trajectory["step"] = 1e-6;
  trajectory["march"] = "every-step";
  Json range = swinging_beam("stability");
  range.erase("step");
  range["mesh"]["elements"] = 6;
  range["methods"]["mass"] = "consistent";
  range["steps"] = {{"from", 1e-5}, {"to", 1e-3}, {"count", 16}};
  // How fast a machine is, or how much of it is to be had, goes into all of them alike. What it has of each instruction
  // goes into steps of one lane and of eight by 4 at most, and the model of cost is good for a factor of 3.
  const double here = taken_over_predicted(trajectory);
  for (const Json& study : {sweep, range}) {
    const double there = taken_over_predicted(study);
    CAPTURE(here, there);
#ifndef RICOCHET_SANITIZED  // sanitized code is not what is predicted
    CHECK(there < 12 * here);
    CHECK(here < 12 * there);
#endif
  }
}

namespace {

// A tube between two supports, in two planes, pushed at one place, at stops that have names.
Json pushed_tube(int stops, const Json& stop = Json::object()) {
  Json study = Json::parse(R"study({
    "name": "pushed", "kind": "trajectory",
    "scene": {
      "structure": {"type": "beam", "planes": 2, "length": 1.2, "section": {"type": "given", "EI": 500, "rhoS": 0.5},
                    "damping": {"stiffness": 2e-5},
                    "supports": [{"name": "a", "x": 0, "type": "pinned"}, {"name": "b", "x": 1.2, "type": "pinned"}]},
      "stops": [], "load": [{"at": {"x": 0.7, "component": "uy"}, "force": "20*sin(300*t)"}]},
    "mesh": {"elements": 12},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 1e6}, "time": "newmark-dumont-paoli"},
    "step": 1e-5, "duration": 0.5, "march": "every-step"})study");
  for (int i = 0; i < stops; ++i) {
    Json one = {
        {"name", "s" + std::to_string(i)}, {"at", {{"x", 0.1 * (i + 1)}, {"component", "uy"}}}, {"lower", -1e-4}};
    one.update(stop);
    study["scene"]["stops"].push_back(one);
  }
  return study;
}

// Of the one case, without what a machine adds.
CasePlan planned_alone(const Json& study) {
  Planned planned(study);
  REQUIRE(planned.study.cases.size() == 1);
  const CasePlan plan = planned.cases.front().plan;
  REQUIRE(plan.refusal.empty());
  return plan;
}
double modelled_seconds(const Json& study) {
  return planned_alone(study).predicted_seconds;
}

}  // namespace

TEST_CASE("forecast: stops, their tangents and friction cost, each on top of the other") {
  const Json tangent = {{"tangent", {{"component", "uz"}}}};
  Json rubs = tangent;
  rubs["friction"] = 0.3;
  const double one = modelled_seconds(pushed_tube(1)), four = modelled_seconds(pushed_tube(4)),
               eight = modelled_seconds(pushed_tube(8));
  CHECK(one < four);
  CHECK(four < eight);
  const double slides = modelled_seconds(pushed_tube(4, tangent)), rubbed = modelled_seconds(pushed_tube(4, rubs));
  CHECK(four < slides);
  CHECK(slides < rubbed);
  CHECK(modelled_seconds(pushed_tube(1, rubs)) < rubbed);
}

TEST_CASE("forecast: a beam that is pressed onto many stops costs more than one that never comes to them") {
  Json study = swinging_beam("trajectory");
  study["mesh"]["elements"] = 40;
  study["methods"]["mass"] = "consistent";
  study["march"] = "every-step";
  study["step"] = 5e-5;
  study["scene"]["load"] = "-1e3";
  study["scene"]["initial"] = {{"displacement", "0"}};
  study["scene"]["stops"] = {{"lower", -1e3}, {"upper", 1e3}, {"at", "nodes"}};
  const double never = modelled_seconds(study);
  study["scene"]["stops"] = {{"lower", -1e-6}, {"upper", 1e-6}, {"at", "nodes"}};
  CHECK(modelled_seconds(study) > 2 * never);
}

TEST_CASE("forecast: loads cost what evaluating them takes") {
  const auto forces = [](int count, const Json& force) {
    // Stops that are never touched: forces change how often others are.
    Json study = pushed_tube(1, {{"lower", -1e3}}), load = Json::array();
    for (int i = 0; i < count; ++i)
      load.push_back({{"at", {{"x", 0.1 * (i + 1)}, {"component", "uy"}}}, {"force", force}});
    study["scene"]["load"] = load;
    return modelled_seconds(study);
  };
  const double plain = forces(1, "20*t"), harmonic = forces(1, "20*sin(300*t)");
  CHECK(plain < harmonic);
  CHECK(harmonic < forces(4, "20*sin(300*t)"));
}

TEST_CASE("forecast: a window whose parts are told costs more, and no step is free") {
  Json study = pushed_tube(2), windowed = study;
  windowed["window"] = {{"from", 0.1}, {"to", 0.5}, {"parts", 8}};
  const CasePlan plan = planned_alone(study);
  CHECK(plan.predicted_seconds < modelled_seconds(windowed));
  // A loaded step that is shown to nobody but the audit took 0.6 µs and more wherever it was measured.
  constexpr double floor = 2e-7;
  CHECK(plan.predicted_seconds > floor * static_cast<double>(plan.steps));
  study["duration"] = 5;  // contact is counted on a longer part of it
  CHECK(modelled_seconds(study) / plan.predicted_seconds == Approx(10).epsilon(0.2));
}

TEST_CASE("forecast: a window makes every step of an unloaded march be shown") {
  Json study = swinging_beam("trajectory");
  study["mesh"]["elements"] = 8;
  study["methods"]["mass"] = "consistent";
  study["step"] = 5e-5;
  study["march"] = "every-step";
  const double alone = modelled_seconds(study);
  study["window"] = {{"from", 0.1}, {"to", 0.2}};
  CHECK(alone < modelled_seconds(study));
}

TEST_CASE("forecast: orbits that begin in the state of the scene are planned from there") {
  Json study = Json::parse(R"({
    "name": "behind", "kind": "bifurcation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "force": {"amplitude": 1, "pulsation": 2}},
              "stops": {"upper": -0.1, "at": "tip"}, "initial": {"displacement": -0.1}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "restitution": 0.5}},
    "parameter": {"pointer": "/scene/structure/force/pulsation", "values": [2.85, 2.89]},
    "steps_per_period": 100, "start": ["state"], "transient": {"periods": 5, "at_most": 5}, "keep": 16})");
  CHECK(Planned(study).cases.front().plan.refusal.empty());
  study["start"] = Json::array({"rest"});
  // At rest it would begin beyond its stop, at every value.
  CHECK_THROWS_AS(Planned(study), InputError);
}

using namespace ricochet;

namespace {

StudyCase some_case() {
  StudyCase one = fake_study(1).cases.front();
  one.scene_json = {{"support", {{"amplitude", 0.02}, {"pulsation", 10}}}, {"load", "x"}};
  one.elements = 10;
  return one;
}

}  // namespace

TEST_CASE("cases that differ in the size of the scene's numbers alone cost alike, others do not") {
  const StudyCase one = some_case();
  StudyCase other = one;
  other.id = "other";
  other.scene_json["support"]["amplitude"] = 0.5;
  other.axes.emplace_back("support.amplitude", 0.5);
  CHECK(cost_key(one) == cost_key(other));
  const std::vector<std::function<void(StudyCase&)>> changes = {
      [](StudyCase& c) { c.scene_json["support"]["amplitude"] = 0; },
      [](StudyCase& c) { c.scene_json["support"]["amplitude"] = nullptr; },
      [](StudyCase& c) { c.scene_json["load"] = "2*x"; },
      [](StudyCase& c) { c.mass.name = "lumped"; },
      [](StudyCase& c) { c.contact.parameters.set("stiffness", 1e5); },
      [](StudyCase& c) { c.time.name = "bathe"; },
      [](StudyCase& c) { c.elements = 11; },
      [](StudyCase& c) { c.step *= 0.5; },
      [](StudyCase& c) { c.steps_per_period = 100; },
      [](StudyCase& c) { c.duration = 2; },
      [](StudyCase& c) { c.samples = 51; },
      [](StudyCase& c) { c.march = "auto"; },
      [](StudyCase& c) {
        c.settings = {{"budget", 1}};
      },
      [](StudyCase& c) {
        c.references.push_back({"self", {}});
      }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO(i);
    StudyCase changed = one;
    changes[i](changed);
    CHECK(cost_key(changed) != cost_key(one));
  }
}

TEST_CASE("a run plans one of alike cases, and goes on to the next where the first cannot be told") {
  const ScratchFolder scratch;
  Study study = fake_study(6);
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    StudyCase& one = study.cases[i];
    one.scene_json = {{"support", {{"amplitude", 1.0 + static_cast<double>(i)}}}};
    one.mass.name = i < 3 ? "first" : "second";
    one.step = 0.1;
  }
  FakeRun run(scratch);
  std::atomic<int> planned{0};
  run.runner.plan = [&](const StudyCase& one) {
    ++planned;
    CasePlan plan;
    if (one.id == study.cases[0].id) plan.refusal = "not this one";
    if (one.id == study.cases[3].id) throw std::runtime_error("no plan");
    if (one.id != study.cases[0].id) plan.predicted_seconds = one.mass.name == "first" ? 1 : 2;
    return plan;
  };
  std::vector<std::string> order;
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    order.push_back(one.mass.name);
    return fake_result(one);
  };
  RunOptions options;
  options.out = scratch.path() / "out";
  options.jobs = 1;
  CHECK(run(study, options) == 0);
  CHECK(planned == 4);
  CHECK(order == std::vector<std::string>{"second", "second", "second", "first", "first", "first"});
}
