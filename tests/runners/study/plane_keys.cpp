// Keys of beams in two planes and of clearances, and each sentence that refuses them.
#include <catch2/catch.hpp>

#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;

namespace {

Json plane_study(int planes = 2) {
  Json study = small_study();
  study["scene"]["structure"]["planes"] = planes;
  study["scene"]["stops"] = Json::parse(R"([{"name": "plate", "at": {"x": 0.7}, "clearance": {"radius": 1e-3}}])");
  study["scene"]["initial"] = Json::object();
  return study;
}

Json plane_changed(const std::string& pointer, const Json& value, int planes = 2) {
  Json study = plane_study(planes);
  study[Json::json_pointer(pointer)] = value;
  return study;
}

const SceneSpec& scene_of(const Study& study) {
  return study.cases.front().scene;
}

}  // namespace

TEST_CASE("a clearance is read as the rows of its polygon, which have its name") {
  const Study study = parse(plane_study());
  const std::vector<NamedStop>& rows = scene_of(study).stops.named;
  REQUIRE(rows.size() == 8);
  for (const NamedStop& row : rows) {
    CHECK(row.name == "plate");
    CHECK(row.entry == 0);
    CHECK(row.at.component == "uy");
    CHECK(row.side->across.component == "uz");
    CHECK(row.upper == 1e-3);
    CHECK(row.lower == -1e-3);
  }
  // What is absent is written out in the clearance, and read again as it is.
  CHECK(study.resolved["scene"]["stops"][0]["clearance"]["sides"] == 16);
  CHECK(parse(study.resolved).resolved == study.resolved);
  // A list of sides is an axis.
  const Study several = parse(plane_changed("/scene/stops/0/clearance/sides", {4, 5}));
  CHECK(several.cases.size() == 2 * study.cases.size());
  CHECK(several.cases.front().scene.stops.named.size() == 2);
  CHECK(several.cases.back().scene.stops.named.size() == 5);
}

TEST_CASE("studies of one plane are written as they were") {
  const Json plain = parse(small_study()).resolved;
  CHECK_FALSE(plain["scene"]["structure"].contains("planes"));
  CHECK_FALSE(plain["scene"]["initial"].contains("displacement_z"));
  Json one = small_study();
  one["scene"]["structure"]["planes"] = 1;
  CHECK(parse(one).cases.front().id == parse(small_study()).cases.front().id);
}

TEST_CASE("loads, motions, initial states and supports of a beam say their component") {
  Json study = plane_study();
  study["scene"]["structure"]["supports"] = Json::parse(
      R"([{"name": "a", "x": 0, "type": "pinned"}, {"name": "b", "x": 1, "type": "pinned", "components": ["uz"]}])");
  study["scene"]["load"] = Json::parse(R"([{"at": {"x": 0.5, "component": "uz"}, "force": "t"},
                                           {"at": {"x": 0.5, "direction": [3, 4]}, "force": "t"},
                                           {"shape": "x", "time": "t", "component": "uz"}, {"at": 0.5, "force": "t"}])");
  study["scene"]["motions"] = Json::parse(
      R"([{"supports": "all", "component": "uz", "displacement": {"formula": "0.001*t", "every": 0.01, "until": 1}}])");
  study["scene"]["initial"] = Json::parse(R"({"displacement_z": "1e-4*x", "velocity_z": "x"})");
  const Study made = parse(study);
  const SceneSpec& scene = scene_of(made);
  CHECK(scene.load.terms[0].towards.component == "uz");
  CHECK(scene.load.terms[1].towards.direction == std::vector<double>{3, 4});
  CHECK(scene.load.terms[2].towards.component == "uz");
  CHECK(scene.load.terms[3].towards == Place{});
  CHECK(scene.motions[0].component == "uz");
  CHECK(scene.initial.displacement_z(0.5) == 0.5e-4);
  CHECK(std::get<BeamSpec>(scene.structure).supports->at(1).in_plane == std::array<bool, 2>{false, true});
  CHECK(parse(made.resolved).resolved == made.resolved);
}

TEST_CASE("bad clearances and planes are refused with place, what was found and the nearest name") {
  CHECK(refusal(plane_study()).empty());
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/clearance/radius", 0)),
             Contains("/scene/stops/0/clearance/radius: expected a number") && Contains("in m, found 0"));
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/clearance/sides", 2)),
             Contains("/scene/stops/0/clearance/sides: expected a whole number in [3, 720], found 2"));
  CHECK(refusal(plane_changed("/scene/stops/0/clearance/sides", 5)).empty());
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/clearance/side", 5)), Contains("did you mean \"sides\"?"));
  CHECK_THAT(
      refusal(plane_changed("/scene/stops/0/clearance/components", {"uy", "uzz"})),
      Contains("/scene/stops/0/clearance/components/1: no component \"uzz\"") && Contains("did you mean \"uz\"?"));
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/clearance/components", {"uy"})),
             Contains("/scene/stops/0/clearance/components: 1 components; expected two"));
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/clearance/offset", {1e-4})),
             Contains("/scene/stops/0/clearance/offset: 1 number; expected two, along the components of the circle"));
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/upper", 1e-3)),
             Contains("/scene/stops/0/upper: a clearance is bounded by its radius; expected no other bound"));
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/at", {{"x", 0.7}, {"component", "uy"}})),
             Contains("/scene/stops/0/at: a clearance has components of its own"));
  CHECK_THAT(
      refusal(plane_changed("/scene/stops/0/tangent", {{"component", "uy"}})),
      Contains("/scene/stops/0/tangent: stop plate is a clearance, which knows its circle: give slope_radius, or leave "
               "tangent out"));
  CHECK_THAT(refusal(plane_study(1)),
             Contains("/scene/stops/0/clearance/components/1: a beam of one plane moves along uy"));
  Json held = plane_study();
  held["scene"]["structure"]["supports"] = Json::parse(
      R"([{"name": "a", "x": 0, "type": "clamped"}, {"name": "b", "x": 0.7, "type": "pinned", "components": ["uz"]}])");
  CHECK_THAT(refusal(held), Contains("/scene/stops/0/clearance/components/1: plate is held along it"));
  CHECK_THAT(refusal(plane_study(3)), Contains("/scene/structure/planes: expected a whole number in [1, 2], found 3"));
  CHECK_THAT(refusal(with("/scene/structure/section", {{"type", "given"}, {"EI", 1}, {"rhoS", 1}, {"EI_z", 2}})),
             Contains("/scene/structure"));
  CHECK_THAT(refusal(with("/scene/stops", Json::parse(R"([{"name": "a", "at": {"node": "N1"}, "upper": 1}])"))),
             Contains("/scene/stops/0/at: a node without component or direction"));
  CHECK_THAT(refusal(with("/scene/initial/displacement_z", "x")),
             Contains("/scene/initial/displacement_z: only a beam of planes 2"));
  CHECK_THAT(refusal(plane_changed("/scene/stops/0/at", {{"x", 0.7}, {"direction", {1, 0, 0}}})),
             Contains("/scene/stops/0/at/direction: expected two numbers, along y and z"));
}

TEST_CASE("a fault of a stop behind a clearance is told at its own number") {
  Json study = plane_study();
  study["scene"]["stops"].push_back(Json::parse(R"({"name": "end", "at": {"x": 1.7}, "upper": 1})"));
  CHECK_THAT(refusal(study), Contains("/scene/stops/1/at/x: 1.7 m is beyond the beam"));
  study["scene"]["stops"][1] = Json::parse(R"({"name": "plate", "at": {"x": 1.2}, "upper": 1})");
  CHECK_THAT(refusal(study), Contains("/scene/stops/1/name: two stops are called \"plate\""));
}
