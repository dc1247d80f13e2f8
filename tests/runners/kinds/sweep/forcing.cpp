// What drives a scene, and its period.
#include "runners/kinds/sweep/forcing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/runners/kinds/sweep/sweep_case.hpp"
#include "tests/runners/kinds/trajectory/case_runs.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using namespace ricochet::tests;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace forcing_tests {
namespace {

std::string forcing_problem(const SceneSpec& scene) {
  return testing::input_error([&] { check_forcing(scene); }, "");
}

SceneSpec shaken(const std::string& load) {
  SceneSpec scene = parse(small_sweep()).cases.front().scene;
  scene.load = Formula(load, "/scene/load", "xt");
  return scene;
}

}  // namespace

TEST_CASE("The pulsation of a forcing is that of what moves") {
  SceneSpec scene = parse(small_basins()).cases.front().scene;
  CHECK(forcing_pulsation(scene) == 2.2);
  CHECK(is_forced(scene));
  scene.support = {0, 10, 0};
  CHECK(forcing_pulsation(scene) == 2.2);  // the support does not move
  scene.support.amplitude = 0.1;
  CHECK(forcing_pulsation(scene) == 10);
  CHECK_THAT(forcing_problem(scene), StartsWith("/scene/structure/force/pulsation: "));
  std::get<OscillatorSpec>(scene.structure).force.pulsation = 30;  // every third of it is the support's
  CHECK(forcing_problem(scene).empty());
  scene.support.amplitude = 0;
  std::get<OscillatorSpec>(scene.structure).force = {};
  CHECK(forcing_pulsation(scene) == 10);  // still the period in which steps are counted
  CHECK_FALSE(is_forced(scene));
  scene.support.pulsation = 0;
  CHECK(forcing_pulsation(scene) == 0);
  CHECK_THAT(forcing_problem(scene), StartsWith("/scene/support/pulsation: "));
}

TEST_CASE("A load must repeat with the forcing, whatever else it does") {
  CHECK(forcing_problem(shaken("x^2")).empty());
  CHECK(forcing_problem(shaken("x*cos(10*t) + 3*sin(40*t)^3 + 1")).empty());
  CHECK(forcing_problem(shaken("sin(10*t + 3*x)")).empty());
  for (const char* load : {"sin(10.0001*t)", "sin(7.3*t)", "exp(-t)", "t", "x*t", "t > 3 ? 1 : 0", "t > 100 ? 1 : 0"}) {
    INFO(load);
    CHECK_THAT(forcing_problem(shaken(load)), StartsWith("/scene/load: ") && Contains("period"));
  }
}

TEST_CASE("forcing: what repeats together has the shortest period of all") {
  SceneSpec scene = parse(small_basins()).cases.front().scene;
  auto& force = std::get<OscillatorSpec>(scene.structure).force;
  // Ratio of two pulsations, and of the common one to the first.
  for (const auto& [ratio, common] : {std::pair(1.5, 0.5), {2.0 / 3, 1.0 / 3}, {0.25, 0.25}, {4.0, 1.0}, {0.7, 0.1}}) {
    CAPTURE(ratio);
    scene.support = {0.1, 3, 0};
    force = {1, 3 * ratio, 0.2};
    CHECK(forcing_problem(scene).empty());
    CHECK(forcing_pulsation(scene) == Approx(3 * common).epsilon(1e-14));
  }
  force = {1, 4.5, 0};
  CHECK(forcing_note(scene) == "the forcing repeats after 4.18879 s: 2 of the support, 3 of the force");
  force = {1, 6, 0};
  CHECK(forcing_note(scene).empty());
  CHECK(forcing_pulsation(scene) == 3);
  // Both numbers are told of what has no common period, the pulsation and the period of each.
  for (const double other : {3 * std::sqrt(2.0), 3.0001, 3 / std::numbers::phi}) {
    force.pulsation = other;
    CHECK_THAT(forcing_problem(scene), StartsWith("/scene/structure/force/pulsation: the force does not repeat with "
                                                  "the support: ") &&
                                           Contains(fmt::format("{:.9g} rad/s and 3 rad/s", other)) &&
                                           Contains(fmt::format("{:.9g} s and 2.0943951 s", 2 * M_PI / other)));
  }
}

TEST_CASE("forcing: loads by formulas have the period of their waves") {
  SceneSpec scene = shaken("0");
  scene.support = {};
  const auto loaded = [&](const std::vector<std::string>& forces) {
    scene.load = {};
    for (const std::string& text : forces)
      scene.load.terms.push_back(
          {.force = true, .at = 1.0, .shape = Formula(), .history = Formula(text, "/scene/load/0/force", "t")});
    return scene;
  };
  for (const auto& [forces, pulsation] :
       std::vector<std::pair<std::vector<std::string>, double>>{{{"3*cos(4*t)"}, 4},
                                                                {{"3*cos(4*t + 0.3)"}, 4},
                                                                {{"sin(2*pi*t/0.5)"}, 4 * M_PI},
                                                                {{"1 + cos( 6*t )*sin(4*t)"}, 2},
                                                                {{"sin(4*t)^2"}, 8},
                                                                {{"abs(sin(4*t))"}, 8},
                                                                {{"sin(t/2 + sin(t/2))"}, 0.5},
                                                                {{"cos(4*t)", "sin(6*t)"}, 2},
                                                                {{"5", "cos(4*t)"}, 4},
                                                                {{"sin(4*t) > 0.2 ? 1 : 0"}, 4}}) {
    CAPTURE(forces);
    CHECK(forcing_problem(loaded(forces)).empty());
    CHECK(forcing_pulsation(scene) == Approx(pulsation).epsilon(1e-9));
    CHECK(is_forced(scene));
  }
  scene.load = Formula("x*cos(5*t + 2*x)", "/scene/load", "xt");
  CHECK(forcing_problem(scene).empty());
  CHECK(forcing_pulsation(scene) == Approx(5).epsilon(1e-12));
  CHECK_THAT(forcing_problem(loaded({"sin(t)", "sin(sqrt(2)*t)"})),
             Contains("1.41421356 rad/s and 1 rad/s") && Contains("no common period"));
  // No wave, or one that does not repeat.
  for (const char* force : {"exp(-t)", "sin(t^2)", "t", "sin(t)*exp(-t)", "sin(t*exp(t/1000))"})
    CHECK_THAT(forcing_problem(loaded({force})), Contains("period"));
}

TEST_CASE("forcing: the force of a body is a force of the scene, whatever the kind of study") {
  const Json oscillator = Json::parse(R"({"type": "oscillator", "mass": 2, "stiffness": 9, "damping": 0.3})");
  Json pushed = oscillator, turned = oscillator;
  pushed["force"] = {{"amplitude", 0.7}, {"pulsation", 1.3}, {"phase", 0.4}};
  turned["force"] = {{"amplitude", 0.7}, {"pulsation", 0.0}, {"phase", 0.4}};
  const auto trajectory = [](Json scene) {
    scene["points"] = Json::array();
    if (scene.contains("bodies")) scene["points"] = Json::parse(R"([{"name": "p", "at": {"body": "second"}}])");
    if (scene["points"].empty()) scene.erase("points");
    Json study = Json::parse(R"({"name": "pushed", "kind": "trajectory", "step": 0.01, "duration": 6,
      "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark"}})");
    study["scene"] = std::move(scene);
    const CaseRecord record = CaseRuns().first_of(study);
    REQUIRE(record.status == Status::done);
    return record.curve.columns.at(1).get();
  };
  for (const Json& forced : {pushed, turned}) {
    const std::vector<double> alone = trajectory({{"structure", forced}});
    Json two = {{"bodies", {{"first", oscillator}, {"second", forced}}}};
    const std::vector<double> beside = trajectory(two);
    // The same force as a load at the place of the body.
    two["bodies"]["second"] = oscillator;
    two["load"] = Json::array(
        {{{"at", {{"body", "second"}}}, {"force", forced == pushed ? "0.7*cos(1.3*t + 0.4)" : "0.7*cos(0.4)"}}});
    const std::vector<double> loaded = trajectory(two);
    REQUIRE(alone.size() == beside.size());
    double largest = 0, worst = 0, as_load = 0;
    for (std::size_t i = 0; i < alone.size(); ++i) {
      largest = std::max(largest, std::abs(alone[i]));
      worst = std::max(worst, std::abs(alone[i] - beside[i]));
      as_load = std::max(as_load, std::abs(loaded[i] - beside[i]));
    }
    CHECK(largest > 0.05);
    CHECK(worst <= 1e-12 * largest);  // another order of sums
    CHECK(as_load <= 1e-12 * largest);
  }
}

namespace {

/// A particle in the cavity of a driven structure. Motions: an event-driven program of another hand.
Json impact_damper(double value) {
  Json study = Json::parse(R"({
    "name": "damper", "kind": "bifurcation",
    "scene": {
      "bodies": {"primary": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.04,
                             "force": {"amplitude": 0.1, "pulsation": 1}},
                 "particle": {"type": "oscillator", "mass": 0.1, "stiffness": 0}},
      "stops": [{"name": "cavity", "at": {"body": "particle"}, "to": {"body": "primary"}, "lower": -0.6, "upper": 0.6}],
      "initial": {"primary": {"displacement": 0.4}, "particle": {"velocity": 0.3}}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "moreau-jean", "theta": 0.5, "restitution": 0.6}},
    "steps_per_period": 1000, "start": ["state"], "transient": {"periods": 200, "at_most": 200},
    "keep": 32, "exponents": 0, "refine": null})");
  study["parameter"] = {{"pointer", "/scene/bodies/primary/force/pulsation"}, {"values", {value}}};
  return study;
}

}  // namespace

TEST_CASE("forcing: an impact damper whose structure is driven by its force has the motions of the published map") {
  for (const auto& [pulsation, impacts] : {std::pair(0.925, 4.0), {1.0, 3.0}, {1.05, 2.0}}) {
    CAPTURE(pulsation);
    const CaseRecord record = run_sweep(impact_damper(pulsation));
    REQUIRE(record.status == Status::done);
    CHECK(of_values(record, "class").front().text() == "periodic");
    CHECK(of_values(record, "period").front().number() == 1.0);
    CHECK(of_values(record, "impacts_per_period").front().number() == impacts);
  }
}

TEST_CASE("forcing: forces of bodies in the ratio 3 : 2 repeat together, others are refused with both numbers") {
  Json study = impact_damper(1.05);
  study["scene"]["bodies"]["particle"]["force"] = {{"amplitude", 1e-3}, {"pulsation", 0.7}, {"phase", 0}};
  const CaseRecord record = run_sweep(study);
  CHECK(record.status == Status::done);
  study["scene"]["bodies"]["particle"]["force"]["pulsation"] = 0.777;
  CHECK_THAT(testing::input_error([&] { opened_sweep(study); }, ""),
             StartsWith("/scene/bodies/particle/force/pulsation: the force on particle does not repeat with the force "
                        "on primary: 0.777 rad/s and 1.05 rad/s"));
}

}  // namespace forcing_tests
