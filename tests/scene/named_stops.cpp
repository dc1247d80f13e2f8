// Stops that have names: rows of places, and what a list of them may not be.
#include <ricochet/scene/named_stops.hpp>

#include "tests/places.hpp"
#include "tests/refusals.hpp"
#include "tests/scene/structure/beam_files.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

Place at_x(double x) {
  Place place;
  place.x = x;
  return place;
}

SceneSpec with_stops(SceneSpec scene, std::vector<NamedStop> stops) {
  scene.stops = {};
  scene.stops.named = std::move(stops);
  return scene;
}

std::string fault(const SceneSpec& scene, int elements = 4) {
  return input_error([&] { check_scene(scene, elements); });
}

}  // namespace

TEST_CASE("stops that have names are the stops of the same places without") {
  SceneSpec plain = unit_beam();
  plain.stops.place = StopsSpec::Place::positions;
  plain.stops.positions = {0.6, 1};
  plain.stops.lower = Formula(-0.1);
  plain.stops.upper = Formula(0.1);
  const SceneSpec named =
      with_stops(unit_beam(), {{"plate", at_x(0.6), {}, -0.1, 0.1}, {"end", at_x(1), {}, -0.1, 0.1}});
  const auto consistent = mass("consistent");
  const SemiDiscrete a = discretised(plain, 4, *consistent), b = discretised(named, 4, *consistent);
  CHECK((a.contact - b.contact).norm() == 0);
  CHECK(a.lower == b.lower);
  CHECK(a.upper == b.upper);
  CHECK(a.contact_x == b.contact_x);
  CHECK(a.space.contact_dofs == b.space.contact_dofs);
  CHECK(a.stops.empty());
  CHECK(b.stops == std::vector<std::string>{"plate", "end"});
}

TEST_CASE("a stop between two places bounds the difference of their displacements") {
  const SceneSpec scene = with_stops(unit_beam(), {{"gap", at_x(1), at_x(0.25), std::nullopt, 0.1}});
  const SemiDiscrete problem = discretised(scene, 4, *mass("consistent"));
  // Of w = x: 1 − 0.25.
  Eigen::VectorXd line(8);
  for (int node = 0; node < 4; ++node) line[2 * node] = 0.25 * (node + 1), line[2 * node + 1] = 1;
  CHECK((problem.contact * line)[0] == Approx(0.75).epsilon(1e-14));
  CHECK(problem.upper[0] == 0.1);
  CHECK(std::isinf(problem.lower[0]));
}

TEST_CASE("lists of stops that cannot be are refused by name and pointer") {
  const SceneSpec beam = unit_beam();
  CHECK(fault(with_stops(beam, {{"a b", at_x(1), {}, {}, 0.1}})) ==
        "/scene/stops/0/name: \"a b\"; expected a name of 1 to 40 letters, digits, '-' or '_'");
  CHECK(fault(with_stops(beam, {{"a", at_x(1), {}, {}, 0.1}, {"a", at_x(0.5), {}, {}, 0.1}})) ==
        "/scene/stops/1/name: two stops are called \"a\"");
  CHECK(
      fault(with_stops(beam, {{"a", at_x(1), {}, 4e-4, -4e-4}})) ==
      "/scene/stops/0/lower: stop a: lower 0.0004 m > upper -0.0004 m. Expected lower ≤ upper, or a compliant law that "
      "lets points pass both");
  CHECK(fault(with_stops(beam, {{"a", at_x(1), {}, {}, {}}})) ==
        "/scene/stops/0: stop a has no bound; expected lower, upper or both, in m");
  CHECK(fault(with_stops(beam, {{"a", at_x(0), {}, {}, 0.1}})) ==
        "/scene/stops/0/at: stop a is where the structure is held: nothing there can move");
  CHECK(fault(with_stops(beam, {{"a", at_x(1.2), {}, {}, 0.1}})) ==
        "/scene/stops/0/at/x: 1.2 m is beyond the beam; expected 0 to 1 m");
  CHECK(fault(with_stops(beam, {{"a", at_node("N1"), {}, {}, 0.1}})) ==
        "/scene/stops/0/at: the beam has no nodes that are called; expected {\"x\": position in m}");
  CHECK(fault(with_stops(beam, {{"a", at_x(1), {}, 0.1, 0.2}})) ==
        "/scene/initial/displacement: the initial displacement is 0 m at stop a, beyond the lower stop at 0.1 m; "
        "expected a state between the stops, or a compliant law that lets points pass them");
  SceneSpec shaken = with_stops(beam, {{"a", at_x(1), at_x(0.5), {}, 0.1}});
  shaken.support = {0.01, 3, 0};
  CHECK(fault(shaken) ==
        "/scene/stops/0/to: stop a is between two points of a structure whose clamp moves; expected an amplitude of 0, "
        "or a stop on the ground");
}

namespace {

/// What a law sees of stops, or why it does not.
SemiDiscreteOrRefusal seen(const SceneSpec& scene, const char* law_name) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  REQUIRE(catalogue.require(Role::contact, law_name, registry));
  const auto* entry = registry.contact(law_name);
  REQUIRE(entry);
  std::map<std::string, ParameterValue> values;
  for (const auto& spec : entry->manual.parameters) {
    if (spec.key == "stiffness") values[spec.key] = 1e5;
    if (spec.fallback) values.try_emplace(spec.key, *spec.fallback);
  }
  const Parameters parameters(values);
  const auto law = entry->make(parameters);
  return discretise(scene, 4, *mass("consistent"), law.get(), &parameters);
}

std::string refusal(const SemiDiscreteOrRefusal& answer) {
  return std::holds_alternative<Refusal>(answer) ? std::get<Refusal>(answer).sentence.text : "";
}

}  // namespace

TEST_CASE("of stops at one place a rigid law keeps the nearest bounds, and a compliant one all") {
  const auto at = at_x(1);
  const SceneSpec scene = with_stops(
      unit_beam(), {{"far", at, {}, -0.2, 0.3}, {"near", at, {}, -0.1, 0.2}, {"other", at_x(0.5), {}, {}, 9}});
  const auto rigid = seen(scene, "signorini"), soft = seen(scene, "penalty");
  REQUIRE(std::holds_alternative<SemiDiscrete>(rigid));
  REQUIRE(std::holds_alternative<SemiDiscrete>(soft));
  const auto& kept = std::get<SemiDiscrete>(rigid);
  CHECK(std::isinf(kept.lower[0]));
  CHECK(std::isinf(kept.upper[0]));
  CHECK(kept.lower[1] == -0.1);
  CHECK(kept.upper[1] == 0.2);
  CHECK(kept.upper[2] == 9);
  CHECK(kept.notes == std::vector<std::string>{
                          "stop far: a rigid law never meets its lower bound, behind that of near at one place",
                          "stop far: a rigid law never meets its upper bound, behind that of near at one place"});
  CHECK(std::get<SemiDiscrete>(soft).upper == Eigen::Vector3d(0.3, 0.2, 9));
  CHECK(std::get<SemiDiscrete>(soft).notes.empty());
}

TEST_CASE("stops whose bounds a rigid law cannot tell apart, or cross, are its refusals") {
  const auto at = at_x(1);
  const auto answer = seen(with_stops(unit_beam(), {{"a", at, {}, {}, 0.1}, {"b", at, {}, -1, 0.1}}), "signorini");
  CHECK(refusal(answer) ==
        "stops a and b have one bound at one place, and a rigid law knows only the sum of their forces: keep one of "
        "them, or use a compliant law");
  CHECK_THAT(refusal(answer), names_cause_and_remedy());
  // Behind a nearer one it does not matter which of them acts.
  CHECK(refusal(seen(with_stops(unit_beam(), {{"a", at, {}, {}, 0.1}, {"b", at, {}, -1, 0.1}, {"c", at, {}, {}, 0.05}}),
                     "signorini")) == "");
  const SceneSpec held = with_stops(unit_beam(), {{"a", at, {}, 1e-4, {}}, {"b", at, {}, {}, -1e-4}});
  CHECK(refusal(seen(held, "signorini")).find("the initial displacement is 0 m at stop a") == 0);
  CHECK(refusal(seen(held, "penalty")) == "");
  const SceneSpec gripped = with_stops(unit_beam(), {{"a", at, {}, 1e-4, -1e-4}});
  CHECK(refusal(seen(gripped, "signorini")).find("stop a: lower 0.0001 m > upper -0.0001 m") == 0);
  CHECK(refusal(seen(gripped, "penalty")) == "");
}

TEST_CASE("a stop that is turned round, or weighted, is at the same place") {
  const SceneSpec scene =
      with_stops(unit_beam(), {{"a", at_x(1), at_x(0.5), {}, 0.2}, {"b", at_x(0.5), at_x(1), -0.1, {}}});
  const auto answer = seen(scene, "signorini");
  REQUIRE(std::holds_alternative<SemiDiscrete>(answer));
  CHECK(std::isinf(std::get<SemiDiscrete>(answer).upper[0]));
  CHECK(std::get<SemiDiscrete>(answer).lower[1] == -0.1);
}

TEST_CASE("a scene of given matrices has places, no x") {
  const SceneSpec scene = assembled_scene(assembled(beam_files(std::get<BeamSpec>(unit_beam().structure), 4)));
  const NamedStop end{"end", at_node("N4"), {}, {}, 0.1};
  CHECK(fault(with_stops(scene, {end}), 1) == "no error");
  CHECK(fault(with_stops(scene, {end}), 2) ==
        "/mesh/elements: 2 elements; an assembled structure has the mesh of its files: expected 1");
  CHECK(fault(scene, 1) ==
        "/scene/structure/tip: missing; without stops and loads expected the place whose displacement is shown");
  CHECK(fault(with_stops(scene, {{"c", at_node("N0"), at_node("N0", "rz"), {}, 0.1}}), 1) ==
        "/scene/stops/0/at: stop c joins two held dofs: nothing there can move");
  CHECK(fault(with_stops(scene, {{"c", at_node("N4"), at_node("N4"), {}, 0.1}}), 1) ==
        "/scene/stops/0/at: stop c joins a place to itself; expected two places, or no `to`");
  SceneSpec other = with_stops(scene, {end});
  other.stops.upper = Formula(0.1);
  CHECK(fault(other, 1) ==
        "/scene/stops: an assembled structure has no x; expected a list of stops with name and place");
  other = with_stops(scene, {end});
  other.support = {0.1, 2, 0};
  CHECK(fault(other, 1) ==
        "/scene/support/amplitude: the table of dofs names no support that could move; expected an amplitude of 0");
  other = with_stops(scene, {end});
  other.load.terms.push_back({true, {}, {}, Formula(1.0), at_node("N0")});
  CHECK(fault(other, 1) == "/scene/load/0/at: the force acts where the structure is held: nothing there can move");
  other.load.terms.back().place = std::nullopt;
  CHECK(fault(other, 1) ==
        "/scene/load/0/at: expected the place of the force: node and component, node and direction, or dofs");
  other = with_stops(scene, {end});
  other.load = Formula("x", "/scene/load", "x");
  CHECK(fault(other, 1) ==
        "/scene/load: an assembled structure has no x; expected a list of entries {\"at\": place, \"force\": F(t)}");
}

TEST_CASE("masses made of elements refuse matrices that are given") {
  const SceneSpec scene =
      with_stops(assembled_scene(assembled(beam_files(std::get<BeamSpec>(unit_beam().structure), 4))),
                 {{"end", at_node("N4"), {}, {}, 0.1}});
  for (const char* name : {"singular", "hybrid-singular", "lumped", "mass-scaling", "mixed", "reciprocal"}) {
    const auto answer = discretise(scene, 1, *mass(name));
    INFO(name);
    REQUIRE(std::holds_alternative<Refusal>(answer));
    CHECK(std::get<Refusal>(answer).sentence.text.starts_with("this mass is made of velocities on elements"));
  }
  const SemiDiscrete problem = discretised(scene, 1, *mass("consistent"));
  CHECK(problem.held);
  CHECK(problem.dofs() == 8);
  CHECK(problem.notes == std::vector<std::string>{"the tip is the place of stop end"});
}
