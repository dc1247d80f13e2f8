// Keys of a beam with supports, sections and masses of its own.
#include <catch2/catch.hpp>
#include <set>

#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;
using Catch::Matchers::Contains;

namespace {

Json held_study() {
  Json study = small_study();
  study["scene"]["structure"]["supports"] = Json::parse(R"([
    {"name": "a", "x": 0, "type": "pinned"},
    {"name": "b", "x": 1.2, "type": "elastic", "stiffness": 1e5, "rotation": 20}])");
  study["scene"]["structure"]["masses"] = Json::parse(R"([{"x": 1.5, "mass": 0.1}])");
  study["scene"]["structure"]["tension"] = 3;
  return study;
}

Json changed(const std::string& pointer, const Json& value) {
  Json study = held_study();
  study[Json::json_pointer(pointer)] = value;
  return study;
}

}  // namespace

TEST_CASE("a study gives a beam its supports, masses, tension, what is absent is not written out") {
  const Study study = parse(held_study());
  const auto& beam = std::get<BeamSpec>(study.cases.front().scene.structure);
  REQUIRE(beam.supports);
  REQUIRE(beam.supports->size() == 2);
  CHECK(beam.supports->front().name == "a");
  CHECK(beam.supports->front().type == BeamSupport::Type::pinned);
  CHECK(beam.supports->back().stiffness == 1e5);
  CHECK(beam.supports->back().rotation == 20);
  CHECK(beam.masses.front().mass == 0.1);
  CHECK(beam.masses.front().inertia == 0);
  CHECK(beam.tension == 3);
  CHECK(parse(study.resolved).resolved == study.resolved);
  const Json plain = parse(small_study()).resolved["scene"]["structure"];
  for (const char* key : {"supports", "sections", "added_mass", "tension", "foundation", "masses", "shear"})
    CHECK_FALSE(plain.contains(key));
  // A default that is written is the same case.
  Json written = small_study();
  written["scene"]["structure"]["tension"] = 0;
  CHECK(parse(written).cases.front().id == parse(small_study()).cases.front().id);
}

TEST_CASE("a point mass without mass and inertia is none") {
  CHECK_THAT(refusal(changed("/scene/structure/masses", Json::parse(R"([{"x": 1, "mass": 0.1}, {"x": 1.5}])"))),
             Contains("/scene/structure/masses/1: neither a mass nor an inertia"));
}

TEST_CASE("sections stand in the place of one section") {
  Json study = held_study();
  Json& structure = study["scene"]["structure"];
  const Json part = {{"to", 1.5}, {"section", structure["section"]}, {"young", 2e11}, {"density", 8000}};
  structure["sections"] = Json::array({part});
  CHECK_THAT(refusal(study), Contains("/scene/structure/section: does not go together with \"sections\""));
  structure.erase("section");
  CHECK_THAT(refusal(study), Contains("/scene/structure/young: unknown key"));
  structure.erase("young");
  structure.erase("density");
  CHECK(refusal(study).empty());
  CHECK(std::get<BeamSpec>(parse(study).cases.front().scene.structure).sections.front().young == 2e11);
  structure["sections"][0].erase("young");
  CHECK_THAT(refusal(study), Contains("/scene/structure/sections/0/young: missing"));
}

TEST_CASE("a beam's lists are refused with place, what was found and the nearest name") {
  CHECK_THAT(refusal(changed("/scene/structure/supports/0/type", "pined")),
             Contains("/scene/structure/supports/0/type") && Contains("did you mean \"pinned\"?"));
  CHECK_THAT(refusal(changed("/scene/structure/supports/0/stiffness", 3)),
             Contains("/scene/structure/supports/0/stiffness: unknown key"));
  CHECK_THAT(refusal(changed("/scene/structure/supports/1/x", 3.2)),
             Contains("/scene/structure/supports/1/x: 3.2 m; expected 0 to L = 1.5"));
  CHECK_THAT(refusal(changed("/scene/structure/supports", "clamped")),
             Contains("/scene/structure/supports: expected a list of objects, found \"clamped\""));
  CHECK_THAT(refusal(changed("/scene/structure/suports", Json::array())), Contains("did you mean \"supports\"?"));
  CHECK_THAT(refusal(changed("/scene/structure/tension", -1e9)), Contains("beyond the first buckling load"));
  CHECK_THAT(refusal(changed("/scene/structure/shear", {{"poisson", 0.9}})),
             Contains("/scene/structure/shear/poisson: expected a number in ]-1, 0.5]"));
}

TEST_CASE("numbers of a beam are axes as others are") {
  const Study study = parse(changed("/scene/structure/tension", {0, 10}));
  CHECK(study.cases.size() == 2 * parse(held_study()).cases.size());
  CHECK(std::count(study.columns.begin(), study.columns.end(), "structure.tension") == 1);
  const Study stiffer = parse(changed("/scene/structure/supports/1/stiffness", {1e4, 1e5}));
  CHECK(std::count(stiffer.columns.begin(), stiffer.columns.end(), "structure.supports.1.stiffness") == 1);
  std::set<double> values;
  for (const StudyCase& one : stiffer.cases)
    values.insert(std::get<BeamSpec>(one.scene.structure).supports->back().stiffness);
  CHECK(values == std::set<double>{1e4, 1e5});
  CHECK_THAT(refusal(changed("/scene/structure/supports/1/x", {1.2, 1.7})),
             Contains("/scene/structure/supports/1/x/1: 1.7 m; expected 0 to L = 1.5"));
}
