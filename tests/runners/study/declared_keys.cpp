// What the form says of a key is found from where the key stands, in structures, bodies, lists and places.
#include "runners/study/declared_keys.hpp"

#include <catch2/catch.hpp>

#include "runners/study/axis_meaning.hpp"

using namespace ricochet;

namespace declared_keys_tests {

namespace {

Json study() {
  return Json::parse(R"json({"kind": "trajectory", "scene": {
    "bodies": {"rod": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1},
                       "supports": [{"name": "a", "x": 0, "type": "elastic", "stiffness": 1, "rotation": 0}],
                       "damping": {"stiffness": 0, "mass": 0}},
               "ball": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0}},
    "stops": [{"name": "wall", "at": {"x": 0.5}, "to": null, "lower": null, "upper": 0.1, "stiffness": 1e5}],
    "load": [{"at": {"body": "rod", "x": 0.5}, "force": {"psd": {"formula": "1", "from": 1, "to": 9, "lines": 10}}}],
    "initial": {"rod": {"displacement": "0", "velocity": "0"}}},
    "mesh": {"elements": [10, 20]}, "step": [1e-3, 1e-4]})json");
}

}  // namespace

TEST_CASE("a pointer finds the declaration of its key in the form that the study has there") {
  const Json given = study();
  const auto unit = [&](const std::string& pointer) {
    const Field* field = declared_at(pointer, given);
    return field ? field->spec.unit : "none";
  };
  CHECK(unit("/scene/bodies/rod/length") == "m");
  CHECK(unit("/scene/bodies/rod/section/EI") == "N m²");
  CHECK(unit("/scene/bodies/rod/supports/0/rotation") == "N m/rad");
  CHECK(unit("/scene/bodies/ball/damping") == "N s/m");       // of an oscillator c,
  CHECK(unit("/scene/bodies/rod/damping/stiffness") == "s");  // of a beam α
  CHECK(unit("/scene/bodies/rod/tension") == "N");            // left out, it has its default
  CHECK(unit("/scene/bodies/ball/length") == "none");
  CHECK(unit("/scene/bodies/strap/length") == "none");
  CHECK(unit("/scene/stops/0/stiffness") == "N/m");
  CHECK(unit("/scene/stops/0/at/x") == "m");
  CHECK(unit("/scene/stops/1/upper") == "none");
  CHECK(unit("/scene/load/0/force/psd/from") == "Hz");
  CHECK(unit("/scene/initial/rod/velocity") == "m/s");
  CHECK(unit("/step") == "s");
  CHECK(unit("/scene") == "");
  CHECK(unit("") == "none");
  CHECK_FALSE(declared_at("/scene/stops", Json::object()));
}

TEST_CASE("an axis of a body or of a stop has the unit of its key, and every axis its words") {
  const Json given = study();
  CHECK(axis_meaning("stops.0.upper", given).unit == "m");
  CHECK(axis_meaning("bodies.rod.section.EI", given).unit == "N m²");
  CHECK(axis_meaning("bodies.rod.supports.0.stiffness", given).text == "Spring against w.");
  CHECK(axis_meaning("elements", given).unit == "1");
  CHECK(axis_meaning("time.beta", given).unit.empty());
  CHECK(axis_meaning("structure.length", given).text == "A value of the scene that differs between the cases.");
  CHECK(spoken_choice("bodies.rod.section.EI") == "the bending stiffness EI");
  CHECK(spoken_choice("structure.damping.stiffness") == "the viscosity α");
  CHECK(spoken_choice("structure.stiffness") == "the stiffness of the structure");  // not the file of a matrix
  CHECK(spoken_choice("stops.0.clearance.sides") == "the number of sides");
  CHECK(spoken_choice("mode_residual") == "the residual of the modes");
  CHECK(spoken_choice("time × step") == "the time scheme together with the step");
  CHECK(spoken_choice("structure.colour") == "structure.colour");
}

}  // namespace declared_keys_tests
