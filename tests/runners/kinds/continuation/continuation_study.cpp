// What is refused of a study of kind `continuation`, and in which words.
#include "tests/runners/kinds/continuation/tube_study.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::string error_of(const Json& text) {
  try {
    opened_continuation(text);
  } catch (const InputError& error) {
    return error.pointer() + ": " + error.what();
  }
  return "no error";
}

Json with(const std::string& pointer, Json value) {
  Json study = tube_continuation();
  study[Json::json_pointer(pointer)] = std::move(value);
  return study;
}

void check_says(const std::string& said, const std::vector<std::string>& parts) {
  INFO(said);
  for (const std::string& part : parts) CHECK(said.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE("keys of continuation are refused by pointer, with what was found and expected") {
  check_says(error_of(with("/parameter/from", 0.1)), {"/parameter/from: ", "0.1 to 0.09", "from < to"});
  check_says(error_of(with("/orbits", Json::array())), {"/orbits: an empty list"});
  check_says(error_of(with("/orbits/0/at", 0.2)), {"/orbits/0/at: ", "0.2", "0.07 to 0.09"});
  check_says(error_of(with("/orbits/0/frm", "rest")), {"/orbits/0/frm: unknown key", "did you mean \"from\""});
  check_says(error_of(with("/orbits/0/from", "res")), {"/orbits/0/from: expected one of", "did you mean \"rest\""});
  check_says(error_of(with("/follow", "peices")), {"/follow: ", "did you mean \"pieces\""});
  check_says(error_of(with("/stop_at", "fol")), {"/stop_at: ", "did you mean \"fold\""});
  check_says(error_of(with("/mark", {{"parameter", {0.5}}})), {"/mark/parameter/0: ", "0.5", "0.07 to 0.09"});
  Json twice = with("/orbits/0/symmetric", "yes");
  twice["orbits"][0]["period"] = 2;
  check_says(error_of(twice), {"/orbits/0/symmetric: an orbit of 2 periods", "odd"});
  twice["orbits"][0]["symmetric"] = true;
  check_says(error_of(twice), {"/orbits/0/symmetric: an orbit of 2 periods", "odd"});
  check_says(error_of(with("/orbits/0/symmetric", 1)),
             {"/orbits/0/symmetric: expected true, false or one of \"auto\"", "found 1"});
}

TEST_CASE("continuation follows real numbers of the scene or of a method alone") {
  check_says(error_of(with("/parameter/pointer", "/mesh/elements")),
             {"/parameter/pointer: continuation follows a real number", "/mesh/elements is part of the mesh"});
  check_says(error_of(with("/parameter/pointer", "/steps_per_period")), {"/parameter/pointer: ", "is a count"});
  check_says(error_of(with("/parameter/pointer", "/scene/structure/type")), {"is the word \"beam\""});
  check_says(error_of(with("/parameter/pointer", "/scene/support/amplitde")),
             {"/parameter/pointer: ", "did you mean", "/scene/support/amplitude"});
}

TEST_CASE("a scene without a forcing period has no orbits") {
  check_says(
      error_of(with("/scene/support/pulsation", 0)),
      {"/scene/support/pulsation: no forcing has a period (the pulsation is 0)", "the period of a motion or a table"});
}

TEST_CASE("a mass that the step does not resolve at its stop refuses the case") {
  Json study = tube_continuation();
  study["methods"] = Json::parse(R"({"mass": "consistent", "contact": "signorini",
                                     "time": {"name": "moreau-jean"}})");
  check_says(refusal_of(study), {"stops are met at whole steps by a mass", "use a position-level scheme"});
  study["methods"]["time"] = Json::parse(R"({"name": "newmark-dumont-paoli", "restitution": 0.5})");
  check_says(refusal_of(study), {"stops are met at whole steps by a mass"});
  // Position-level stops without restitution are a projection, whatever the mass.
  study["methods"]["time"] = Json::parse(R"({"name": "newmark-dumont-paoli", "restitution": 0})");
  CHECK(refusal_of(study).empty());
}

TEST_CASE("pieces are refused of a parameter that is not affine, and of a law that is not linear") {
  Json study = with("/parameter", Json::parse(R"({"pointer": "/scene/support/pulsation", "from": 9, "to": 11})"));
  study["orbits"][0]["at"] = 10;
  study["follow"] = "pieces";
  check_says(refusal_of(study), {"/scene/support/pulsation does not enter linearly", "follow with steps"});
  Json hertz = tube_continuation();
  hertz["methods"]["contact"] = Json::parse(R"({"name": "hertz", "stiffness": 1e7})");
  CHECK(refusal_of(hertz).empty());
  hertz["follow"] = "pieces";
  check_says(refusal_of(hertz), {"its law is not linear", "follow with steps"});
}

TEST_CASE("an orbit that is asked to be its own image is refused on another scene") {
  Json study = with("/scene/stops/lower", -0.09);
  study["orbits"][0]["symmetric"] = "yes";
  check_says(refusal_of(study), {"the scene is not its own image: lower and upper stops differ by 0.01 m"});
  study["orbits"][0]["symmetric"] = true;
  check_says(refusal_of(study), {"the scene is not its own image: lower and upper stops differ by 0.01 m"});
  study["orbits"][0]["symmetric"] = false;
  CHECK(refusal_of(study).empty());
  Json odd = with("/steps_per_period", 201);
  CHECK(refusal_of(odd).empty());
  odd["orbits"][0]["symmetric"] = true;
  check_says(refusal_of(odd), {"the scene is not its own image: 201 steps per period are an odd number"});
}

TEST_CASE("a branch ends where the scene becomes impossible, and says why") {
  Json study = with("/scene/stops/at", "nodes");
  study["parameter"] = Json::parse(R"({"pointer": "/scene/support/amplitude", "from": 0.06, "to": 0.12})");
  study["orbits"] = Json::parse(R"([{"at": 0.07, "from": "free"}])");
  study["both_ways"] = false;
  for (const char* follow : {"pieces", "steps"}) {
    study["follow"] = follow;
    study["at_most"] = {{"pieces", 3}};
    CHECK(refusal_of(study).empty());
    study["parameter"]["from"] = 0.11;
    study["orbits"][0]["at"] = 0.11;
    check_says(refusal_of(study), {"at 0.11: "});
    study["parameter"]["from"] = 0.06;
    study["orbits"][0]["at"] = 0.07;
  }
  // Without contact up to there: one piece.
  study["scene"]["support"]["pulsation"] = 0.5;
  study["orbits"][0]["at"] = 0.09;
  study["follow"] = "pieces";
  const auto points = points_of(continued(study));
  REQUIRE_FALSE(points.empty());
  check_says(points.back().note, {"the range ends at 0.", "at 0.12: "});
}

TEST_CASE("a root of the step on displacements without mass refuses the case") {
  Json study = tube_continuation();
  study["methods"]["time"]["beta"] = 0.25;
  check_says(refusal_of(study), {"a root of modulus 1 on displacements without mass", "no orbit stands alone"});
}
