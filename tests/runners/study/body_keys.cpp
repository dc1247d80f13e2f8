// Studies of several bodies: meshes and modes of each, places, what is refused; and stops with keys of their own.
#include "runners/study/body_keys.hpp"

#include <catch2/catch.hpp>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>

#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;

namespace {

Json bodies_study() {
  Json study = small_study();
  study["scene"] = Json::parse(R"json({
    "bodies": {"rod": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1}},
               "ball": {"type": "oscillator", "mass": 2, "stiffness": 3}},
    "stops": [{"name": "gap", "at": {"body": "rod", "x": 1}, "to": {"body": "ball"}, "upper": 0.1}],
    "load": [{"at": {"body": "ball"}, "force": "sin(t)"}]})json");
  return study;
}

Json with_body_key(const std::string& pointer, const Json& value) {
  Json study = bodies_study();
  study[Json::json_pointer(pointer)] = value;
  return study;
}

const AssembledStructure& structure_of(const StudyCase& one) {
  return *std::get<AssembledSpec>(one.scene.structure).structure;
}

}  // namespace

TEST_CASE("bodies of a study are joined on the mesh of each case") {
  const Study study = parse(with_body_key("/mesh/elements", Json::array({4, 8})));
  REQUIRE(study.cases.size() == 16);
  for (const StudyCase& one : study.cases) {
    REQUIRE(structure_of(one).joined);
    CHECK(structure_of(one).dofs() == 2 * one.elements + 1);
    CHECK(one.scene.load.terms.at(0).place->body == "ball");
  }
  CHECK(study.resolved["scene"].contains("bodies"));
  CHECK_FALSE(study.resolved["scene"].contains("structure"));
}

TEST_CASE("numbers by body are those of each body, and a mesh is called by their sum") {
  Json given = with_body_key("/mesh/elements", Json::parse(R"([{"rod": 3, "bar": 2}, {"bar": 5, "rod": 7}])"));
  given["scene"]["bodies"]["bar"] = {{"type", "bar"}, {"length", 1}, {"EA", 1}, {"rhoA", 1}, {"fixed", "right"}};
  const Study study = parse(given);
  for (const StudyCase& one : study.cases) {
    const std::vector<JoinedBody>& all = structure_of(one).joined->all;
    REQUIRE(all.size() == 3);
    CHECK(one.elements == (all[0].elements == 3 ? 5 : 12));
    CHECK(all[0].elements == (one.elements == 5 ? 3 : 7));
    CHECK(all[1].elements == 1);
    CHECK(all[2].elements == (one.elements == 5 ? 2 : 5));
  }
  CHECK(said_of_mesh(study.resolved, "elements", 12) == Json{{"rod", 7}, {"bar", 5}});
  CHECK(said_of_mesh(study.resolved, "elements", 6) == 6);
  given["mesh"]["modes"] = {{"rod", 2}, {"ball", 1}, {"bar", 2}};
  CHECK(parse(given).cases.front().scene.basis == BasisSpec{5, true, {2, 1, 2}});
  given["mesh"]["modes"].erase("ball");
  CHECK(refusal(given) == "/mesh/modes: says no number for one of the bodies; expected one for each");
}

TEST_CASE("a body that one element cannot be is one of more elements") {
  Json given = with_body_key("/mesh/elements", 4);
  given["scene"]["bodies"]["rod"]["supports"] =
      Json::parse(R"([{"name": "left", "x": 0, "type": "clamped"}, {"name": "right", "x": 1, "type": "clamped"}])");
  given["scene"]["bodies"]["rod"]["length"] = 1;
  CHECK(structure_of(parse(given).cases.front()).joined->all.front().dofs() == 6);
  given["mesh"]["elements"] = 1;
  CHECK_THAT(refusal(given), Catch::StartsWith("/scene/bodies/rod/supports: the supports hold every dof"));
}

TEST_CASE("one body is a structure like any other") {
  Json single = small_study(), body = small_study();
  body["scene"]["bodies"]["tube"] = body["scene"]["structure"];
  body["scene"].erase("structure");
  const Study a = parse(single), b = parse(body);
  REQUIRE(std::holds_alternative<BeamSpec>(b.cases.front().scene.structure));
  CHECK(make_space(a.cases.front().scene.structure, 4).dofs == make_space(b.cases.front().scene.structure, 4).dofs);
  body["scene"]["bodies"]["tube"]["length"] = 1.5;
  body["scene"]["stops"] = Json::parse(R"([{"name": "a", "at": {"body": "tube", "x": 1}, "upper": 0.1}])");
  CHECK(parse(body).cases.front().scene.stops.named.at(0).at.body.empty());
  // An oscillator has one point, alone as beside others.
  body["scene"]["bodies"] = {{"ball", {{"type", "oscillator"}, {"mass", 1}, {"stiffness", 0}}}};
  body["scene"].erase("initial");
  const Json at = {{"body", "ball"}};
  body["scene"]["stops"] = Json::array({{{"name", "a"}, {"at", at}, {"upper", 0.1}}});
  body["scene"]["load"] = Json::array({{{"at", at}, {"force", "sin(t)"}}});
  body["scene"]["points"] = Json::array({{{"name", "p"}, {"at", at}}});
  body["mesh"] = {{"elements", 1}};
  const StudyCase one = parse(body).cases.front();
  CHECK(one.scene.stops.named.at(0).at.x == 0);
  CHECK(one.scene.points.at(0).at.x == 0);
  body["scene"]["stops"][0]["at"] = {{"body", "ball"}, {"node", "N1"}, {"component", "uy"}};
  CHECK_THAT(refusal(body), Contains("/scene/stops/0/at: the oscillator has no nodes"));
}

TEST_CASE("a load is spread along one of the bodies") {
  const Json spread = Json::parse(R"json([{"shape": "1 + x", "time": "cos(t)", "body": "rod"}])json");
  const Study study = parse(with_body_key("/scene/load", spread));
  const StudyCase& one = study.cases.front();
  const DistributedLoad load(one.scene.load, make_space(one.scene.structure, one.elements), &structure_of(one));
  Eigen::VectorXd all(structure_of(one).dofs());
  load.assemble(0, all.data());
  // Against the deflection x² of the rod, clamped at 0: ∫(1 + x) x² dx = 1/3 + 1/4.
  double work = 0;
  for (int node = 1; node <= one.elements; ++node) {
    const double x = node / static_cast<double>(one.elements);
    work += all[2 * (node - 1)] * x * x + all[2 * (node - 1) + 1] * 2 * x;
  }
  CHECK(work == Approx(1.0 / 3 + 0.25).epsilon(1e-12));
  CHECK(all[2 * one.elements] == 0);
  CHECK_THAT(refusal(with_body_key("/scene/load/0/body", "rod")), Contains("does not go together"));
  CHECK_THAT(refusal(with("/scene/load", spread)), Contains("/scene/load/0/body: the scene has one structure"));
  Json assembled = spread;
  assembled[0]["body"] = "bal";
  CHECK_THAT(refusal(with_body_key("/scene/load", assembled)), Contains("nearest ball"));
}

TEST_CASE("bodies that cannot be are refused at their place") {
  CHECK_THAT(refusal(with_body_key("/scene/bodies", Json::object())),
             Contains("/scene/bodies: expected bodies by name"));
  CHECK(refusal(with_body_key("/scene/bodies/rod/length", -1)) ==
        "/scene/bodies/rod/length: expected a number in ]0, ∞[, in m, found -1");
  CHECK_THAT(refusal(with_body_key("/scene/structure", small_study()["scene"]["structure"])),
             Contains("does not go together with \"bodies\""));
  CHECK_THAT(refusal(with_body_key("/scene/stops/0/at/body", "rood")),
             Contains("/scene/stops/0/at/body: no body \"rood\"; nearest rod"));
  CHECK_THAT(refusal(with_body_key("/mesh/elements", {{"rood", 4}})), Contains("did you mean \"rod\"?"));
  CHECK(refusal(with_body_key("/mesh/elements", {{"ball", 4}, {"rod", 1}})) ==
        "/mesh/elements/ball: 4 elements; body ball has no mesh, expected 1");
  CHECK(refusal(with_body_key("/mesh/elements", {{"ball", 1}})) ==
        "/mesh/elements: says no number for body rod; expected one for each beam or bar");
  CHECK_THAT(refusal(with("/mesh/elements", {{"rod", 4}})), Contains("the scene has one structure"));
  CHECK(refusal(with_body_key("/scene/initial", {{"file", "state.csv"}})) ==
        "/scene/initial/file: a file of several bodies; expected an object by body, {\"name\": {\"file\": …}}");
  CHECK_THAT(
      refusal(with_body_key("/scene/initial", {{"displacement", "x"}})),
      Contains("/scene/initial/displacement: bodies have no x in common; expected an object by body, or equilibrium"));
  CHECK_THAT(refusal(with_body_key("/scene/load", "1")), Contains("bodies have no x in common"));
}

TEST_CASE("an initial state by body is refused where its body cannot begin so") {
  const auto begun = [](const char* initial) { return refusal(with_body_key("/scene/initial", Json::parse(initial))); };
  CHECK(begun(R"({"rood": {"displacement": "x"}})") ==
        "/scene/initial/rood: no body \"rood\" (bodies: \"rod\", \"ball\"); did you mean \"rod\"?");
  CHECK(begun(R"({"rod": {"displacement_z": "x"}})") ==
        "/scene/initial/rod/displacement_z: only a beam of planes 2 moves along uz; expected 0");
  CHECK(begun(R"({"rod": {"displacement": "t"}})") != "none");
  CHECK_THAT(begun(R"({"rod": {"displacment": 0}})"), Contains("did you mean \"displacement\"?"));
  CHECK(begun(R"({"rod": {"velocity_factor": 2}})") ==
        "/scene/initial/rod/velocity_factor: multiplies a file, and none is given; expected \"file\"");
  CHECK_THAT(refusal(with("/scene/initial", Json::parse(R"({"rod": {"displacement": 0}})"))),
             Contains("/scene/initial/rod: an initial state by body, and the scene has one structure"));
}

TEST_CASE("a stop has parameters and a motion of its own, and lists of its numbers are axes") {
  Json study = bodies_study();
  Json& stop = study["scene"]["stops"][0];
  stop["stiffness"] = Json::array({1e4, 2e4});
  stop["damping"] = 3;
  stop["restitution"] = 0.5;
  stop["upper"] = Json::array({0.1, 0.2, 0.3});
  stop["moves_with"] = Json::parse(R"({"displacement": {"formula": "0.01*t", "every": 0.01, "until": 1}})");
  const Study made = parse(study);
  CHECK(made.cases.size() == 8 * 6);
  CHECK(std::find(made.columns.begin(), made.columns.end(), "stops.0.stiffness") != made.columns.end());
  const NamedStop& one = made.cases.front().scene.stops.named.at(0);
  CHECK(one.own == StopParameters{1e4, 3, 0.5});
  REQUIRE(one.motion);
  CHECK(one.motion->history->value(0.3) == Approx(0.003).epsilon(1e-12));
  stop["moves_with"]["displacement"]["until"] = 0.05;
  CHECK_THAT(refusal(study), Contains("/scene/stops/0/moves_with/displacement/after: "));
  stop["moves_with"] = "plate";
  CHECK_THAT(refusal(study), Contains("/scene/stops/0/moves_with: no support moves by motions"));
  stop.erase("moves_with");
  stop["restitution"] = 1.5;
  CHECK_THAT(refusal(study), Contains("/scene/stops/0/restitution: expected a number in [0, 1]"));
}

// Where bodies are drawn: what meets stands across, what would overlap does not.

TEST_CASE("a body stands across from what it meets, above what goes upwards to it") {
  const std::vector<BodyShape> bodies = {{0, 0.5, false}, {0, 0.04, false}};
  const auto above = body_places(bodies, {{0, 1, 0.25, 0.02, true}});
  CHECK(above[0].row == 0);
  CHECK(above[1].row == 1);
  CHECK(above[1].shift + 0.02 == Approx(above[0].shift + 0.25));
  const auto below = body_places(bodies, {{0, 1, 0.25, 0.02, false}});
  CHECK(below[1].row == 0);
  CHECK(below[0].row == 1);
}

TEST_CASE("parallel bodies that meet one partner from one side take rows of their own") {
  const std::vector<BodyShape> rods = {{0, 1, false}, {0, 1, false}, {0, 1, false}, {0, 1, false}};
  // Two below the second, and one that meets none.
  const auto places = body_places(rods, {{0, 1, 0.3, 0.3, true}, {2, 1, 0.7, 0.7, true}});
  std::vector<int> rows;
  for (const BodyPlace& one : places) {
    rows.push_back(one.row);
    CHECK(one.shift == 0);
  }
  CHECK(rows == std::vector<int>{1, 2, 0, 3});
}

TEST_CASE("short bodies along a long one share a row") {
  const std::vector<BodyShape> bodies = {{0, 1, false}, {0, 0.1, false}, {0, 0.1, false}};
  const auto places = body_places(bodies, {{0, 1, 0.2, 0.05, true}, {0, 2, 0.8, 0.05, true}});
  CHECK(places[1].row == 1);
  CHECK(places[2].row == 1);
  CHECK(places[2].shift == Approx(0.75));
}

TEST_CASE("what moves along its axis stands in a chain, one in each row") {
  const std::vector<BodyShape> masses = {{0, 0, true}, {0, 0, true}, {0, 0, true}};
  CHECK(all_along(masses));
  const auto places = body_places(masses, {{0, 1, 0, 0, true}, {2, 1, 0, 0, false}});
  CHECK(places[0].row == 0);
  CHECK(places[1].row == 1);
  CHECK(places[2].row == 2);
}
