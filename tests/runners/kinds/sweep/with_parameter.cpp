#include "runners/kinds/sweep/with_parameter.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

StudyCase first_case(const Json& study = small_sweep()) {
  return parse(study).cases.front();
}

std::string problem_of(const StudyCase& one, const std::string& pointer, double value) {
  return testing::input_error([&] { with_parameter(one, pointer, value); }, "");
}

}  // namespace

TEST_CASE("A case at a value is the case that the study would make of the value") {
  Json study = small_sweep();
  study["scene"]["stops"]["at"] = Json::array({0.5, 1.5});
  const StudyCase one = first_case(study);
  struct Change {
    std::string pointer;
    double value;
    Json as;  // what the study would say
  };
  const std::vector<Change> changes = {{"/scene/support/amplitude", 0.075, 0.075},
                                       {"/scene/support/pulsation", 12, 12},
                                       {"/scene/structure/length", 1.75, 1.75},
                                       {"/scene/structure/section/wall", 0.001, 0.001},
                                       {"/scene/structure/damping/stiffness", 1e-4, 1e-4},
                                       {"/scene/stops/lower", -0.2, -0.2},
                                       {"/scene/stops/upper", 0.5, "(0.5)*(0.1 + 0.1*x)"},
                                       {"/scene/stops/at/0", 0.25, 0.25},
                                       {"/scene/initial/velocity", 2, 2},
                                       {"/scene/load", 3, 3}};
  for (const Change& change : changes) {
    INFO(change.pointer);
    Json other = study;
    other[Json::json_pointer(change.pointer)] = change.as;
    const StudyCase wanted = first_case(other), found = with_parameter(one, change.pointer, change.value);
    CHECK(found.scene_json == wanted.scene_json);
    CHECK((*found.scene.stops.upper)(1.5) == (*wanted.scene.stops.upper)(1.5));
    CHECK(found.scene.support.amplitude == wanted.scene.support.amplitude);
    CHECK(found.scene.stops.positions == wanted.scene.stops.positions);
    CHECK(found.axes == wanted.axes);
    CHECK(found.id == one.id);
  }
}

TEST_CASE("A case that marches in modes marches in these at any value") {
  Json study = small_sweep();
  study["mesh"]["modes"] = Json::array({3, nullptr, 5});
  const std::vector<StudyCase> cases = parse(study).cases;
  std::set<int> modes;
  for (const StudyCase& one : cases) {
    const StudyCase moved = with_parameter(one, "/scene/support/amplitude", 0.02);
    CHECK(moved.scene.basis == one.scene.basis);
    modes.insert(one.scene.basis ? one.scene.basis->modes : 0);
  }
  CHECK(modes == std::set<int>{0, 3, 5});
}

TEST_CASE("A formula is multiplied, a formula without variables is a number") {
  Json study = small_sweep();
  study["scene"]["load"] = "x*sin(10*t)";
  study["scene"]["stops"]["lower"] = "-0.05 - 0.05";
  const StudyCase one = first_case(study);
  CHECK(with_parameter(one, "/scene/load", -3).scene.load.spread(0.5, 0.2) == Approx(-3 * 0.5 * std::sin(2.0)));
  CHECK((*with_parameter(one, "/scene/stops/lower", -0.07).scene.stops.lower)(1) == -0.07);
  // Twice is the product: nothing of the first value is lost.
  const StudyCase twice = with_parameter(with_parameter(one, "/scene/load", 2), "/scene/load", 5);
  CHECK(twice.scene.load.spread(1, 0.1) == Approx(10 * std::sin(1.0)));
}

TEST_CASE("A force of a list of loads is a number of the scene, a list of values of a formula is none of objects") {
  Json study = small_sweep();
  study["scene"]["load"] = Json::parse(R"load([{"shape": "x", "time": "cos(10*t)"}, {"at": 1, "force": -2}])load");
  study["scene"]["stops"]["lower"] = {-0.1, -0.2};
  const StudyCase one = first_case(study);
  const SceneSpec pushed = with_parameter(one, "/scene/load/1/force", -3).scene;
  CHECK(pushed.load.terms[1].history(0, 0) == -3);
  CHECK(pushed.load.terms[0].history(0, 0) == 1);
  CHECK(with_parameter(one, "/scene/load/0/time", 4).scene.load.terms[0].history(0, 0) == 4);
  study["scene"]["load"][0]["time"] = "cos(11.7*t)";
  CHECK_THAT(refusal(study), StartsWith("/scene/load/0/time: ") && Contains("does not repeat"));
}

TEST_CASE("A parameter of a method changes that method, and is checked like the study's") {
  Json study = small_sweep();
  study["methods"]["contact"] = Json::array({"rigid", {{"name", "spring"}, {"stiffness", 1000}}});
  study["parameter"] = {{"pointer", "/methods/contact/stiffness"}, {"values", {10, 1e3, 0.1}}};
  const Study read = parse(study);
  for (const StudyCase& one : read.cases) {
    if (one.contact.name == "rigid") {
      REQUIRE(one.excluded);
      CHECK_THAT(*one.excluded, Contains("\"rigid\"") && Contains("\"stiffness\""));
      CHECK_THAT(problem_of(one, "/methods/contact/stiffness", 3), StartsWith("/methods/contact/stiffness: "));
      continue;
    }
    CHECK_FALSE(one.excluded);
    REQUIRE(one.swept.size() == 1);
    CHECK(one.swept.front().second.unit == "N/m");
    const StudyCase at = with_parameter(one, "/methods/contact/stiffness", 25);
    CHECK(at.contact.parameters.real("stiffness") == 25);
    const auto axis = [](const StudyCase& of) {
      for (const auto& [name, value] : of.axes)
        if (name == "contact.stiffness") return value;
      return Json();
    };
    CHECK(axis(one) == "swept");
    CHECK(axis(at) == 25.0);
    CHECK_THAT(problem_of(one, "/methods/contact/stiffness", 0),
               StartsWith("/methods/contact/stiffness: ") && Contains("]0, ∞["));
    CHECK_THAT(problem_of(one, "/methods/contact/evaluation", 0), Contains("no real parameter \"evaluation\""));
  }
}

TEST_CASE("Impossible values are refused with their place") {
  Json study = small_sweep();
  study["scene"]["stops"]["at"] = "nodes";
  study["scene"]["load"] = "sin(10*t)";
  const StudyCase one = first_case(study);
  CHECK_THAT(problem_of(one, "/scene/support/amplitude", 0.2), StartsWith("/scene/support/amplitude: the support"));
  CHECK_THAT(problem_of(one, "/scene/structure/length", -1), StartsWith("/scene/structure/length: ") && Contains("m"));
  CHECK_THAT(problem_of(one, "/scene/structure/section/wall", 0.02), StartsWith("/scene/structure/section/wall: "));
  CHECK_THAT(problem_of(one, "/scene/stops/lower", 0.3), StartsWith("/scene/stops/"));
  CHECK(problem_of(one, "/scene/support/pulsation", 0).empty());  // the load has a period
  // The load repeats every 2π/10 s: with the period of 5 rad/s too, with that of 11.7 rad/s not.
  CHECK(problem_of(one, "/scene/support/pulsation", 5).empty());
  CHECK_THAT(problem_of(one, "/scene/support/pulsation", 11.7), StartsWith("/scene/load: "));
  CHECK_THAT(problem_of(one, "/scene/support/amplitude", std::nan("")), Contains("not a finite"));
  CHECK_THAT(problem_of(one, "/scene/support/amplitud", 0.1), StartsWith("/scene/support/amplitud: names no"));
  CHECK_THAT(problem_of(one, "/scene/stops/at", 0.1), Contains("names no"));
  CHECK_THAT(problem_of(one, "/mesh/elements", 4), Contains("names neither"));
}

TEST_CASE("Two parameters are changed together: only the pair has to be possible") {
  const StudyCase one = first_case();
  const StudyCase at = with_parameters(one, {{"/scene/stops/lower", 0.2}, {"/scene/initial/displacement", 0.205}});
  CHECK((*at.scene.stops.lower)(1) == 0.2);
  CHECK(at.scene.initial.displacement(1) == 0.205);
  CHECK_FALSE(problem_of(one, "/scene/stops/lower", 0.2).empty());
}

TEST_CASE("Starts and values are read from the settings") {
  const Json settings = parse(small_sweep()).cases.front().settings;
  CHECK(parameter_values(settings) == std::vector<double>{0.07, 0.08, 0.09});
  const std::vector<StartSpec> starts = starts_of(settings);
  std::vector<std::string> names;
  for (const StartSpec& start : starts) names.push_back(start.name);
  CHECK(names == std::vector<std::string>{"rest", "up", "down", "random-1", "random-2", "random-3"});
  CHECK(starts[0].kind == StartSpec::rest);
  CHECK(starts[2].kind == StartSpec::down);
  CHECK(starts[5].kind == StartSpec::random);
  CHECK(starts[5].index == 3);
  CHECK(starts[5].seed == 7);
  const std::vector<GridAxis> axes = grid_axes(parse(small_basins()).cases.front().settings);
  REQUIRE(axes.size() == 2);
  CHECK(axes[0].pointer == "/scene/initial/displacement");
  CHECK(axes[0].values == std::vector<double>{-1, -0.5, 0, 0.5, 1});
  CHECK(axes[1].values.size() == 4);
}

TEST_CASE("At rest nothing is left of the initial state") {
  Json study = small_sweep();
  study["scene"]["initial"] = {{"displacement", "0.01*x^2"}, {"velocity", "x"}};
  const StudyCase one = at_rest(first_case(study));
  CHECK(one.scene.initial.displacement.is_zero());
  CHECK(one.scene.initial.velocity.is_zero());
  CHECK(with_parameter(one, "/scene/support/amplitude", 0.08).scene.initial.displacement.is_zero());
}
