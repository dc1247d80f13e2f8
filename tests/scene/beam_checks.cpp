// What a beam refuses, each sentence once.
#include "tests/scene/beam_numbers.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::string said(const SceneSpec& scene, int elements = 10) {
  return input_error([&] { check_scene(scene, elements); });
}

}  // namespace

TEST_CASE("supports outside of the beam, twice at a place or by one name, springs without stiffness") {
  const auto with = [](std::vector<BeamSupport> supports) { return said(held_beam(3, std::move(supports))); };
  CHECK(with({pinned("a", 0), pinned("b", 3.2)}) == "/scene/structure/supports/1/x: 3.2 m; expected 0 to L = 3");
  CHECK(with({pinned("a", 1), clamped("b", 1)}) ==
        "/scene/structure/supports/1/x: two supports at x = 1 m; expected different places");
  CHECK(with({pinned("a", 1), clamped("a", 2)}) ==
        "/scene/structure/supports/1/name: two supports are called \"a\"; expected different names");
  CHECK(with({elastic("a", 1, 0)}).starts_with("/scene/structure/supports/0/stiffness: an elastic support without"));
  CHECK(with({pinned("a", 0), pinned("b", 3)}) == "no error");
}

TEST_CASE("sections end in order, the last one at L, their errors say which") {
  SceneSpec scene = held_beam(3, pinned_at_each(3));
  BeamSpec& beam = beam_of(scene);
  const Section given = beam.section;
  beam.sections = {{2, given, 0, 0}, {1, given, 0, 0}};
  CHECK(said(scene) == "/scene/structure/sections/1/to: 1 m; expected more than 2, where the section begins");
  beam.sections = {{1, given, 0, 0}, {2, given, 0, 0}};
  CHECK(said(scene) == "/scene/structure/sections/1/to: the last section ends at 2 m; expected L = 3");
  beam.sections = {{1, given, 0, 0}, {3, {.type = Section::Type::tube, .outer_diameter = 1, .wall = 0.7}, 1, 1}};
  CHECK(said(scene).starts_with("/scene/structure/sections/1/section/wall: the wall, 0.7 m, is thicker"));
}

TEST_CASE("masses and numbers out of range") {
  SceneSpec scene = held_beam(3, pinned_at_each(3));
  BeamSpec& beam = beam_of(scene);
  beam.masses = {{.x = -1, .mass = 1}};
  CHECK(said(scene) == "/scene/structure/masses/0/x: -1 m; expected 0 to L = 3");
  beam.masses = {{.x = 1, .mass = -1}};
  CHECK(said(scene) == "/scene/structure/masses/0/mass: the point mass is -1 kg; expected a finite number, 0 or above");
  beam.masses.clear();
  beam.foundation = -1;
  CHECK(said(scene).starts_with("/scene/structure/foundation: the stiffness of the foundation is -1 N/m²"));
}

TEST_CASE("compression beyond the first buckling load: π²EI/L² of a pinned beam, a quarter of a clamped one") {
  SceneSpec scene = held_beam(1, {pinned("a", 0), pinned("b", 1)});
  beam_of(scene).tension = -12.3;
  CHECK(said(scene, 20) ==
        "/scene/structure/tension: the tension -12.3 N is beyond the first buckling load, -9.86961 N; expected a "
        "tension above that");
  beam_of(scene).tension = -9.8;
  CHECK(said(scene, 20) == "no error");
  // Cubic elements bring 1e-6 of the load on 20 elements.
  const double euler = std::numbers::pi * std::numbers::pi;
  CHECK(buckling_load(beam_of(scene), 20) == Approx(euler).epsilon(1e-6));
  beam_of(scene).supports = std::nullopt;
  CHECK(buckling_load(beam_of(scene), 20) == Approx(euler / 4).epsilon(1e-6));
  // Guided at both ends it may move aside, and buckles as the pinned one.
  beam_of(scene).supports = {sliding("a", 0), sliding("b", 1)};
  CHECK(buckling_load(beam_of(scene), 20) == Approx(euler).epsilon(1e-6));
  beam_of(scene).supports = {pinned("a", 0)};
  beam_of(scene).tension = -0.1;
  CHECK(said(scene).find("nothing keeps from turning") != std::string::npos);
}

TEST_CASE("stops and forces where the beam is held, a tip that it has not, a support that moves nothing") {
  SceneSpec scene = held_beam(3, pinned_at_each(3));
  scene.stops = {Formula(-1.0), Formula(1.0), StopsSpec::Place::positions, {1.0}};
  CHECK(said(scene) ==
        "/scene/stops/at/0: a stop at x = 1 m is not on the free part of the structure; expected 0 < x < 3 m, apart "
        "from the supports");
  scene.stops.positions = {1.5};
  scene.load.terms = {{.force = true, .at = 2.0, .shape = Formula(), .history = Formula(1.0)}};
  CHECK(said(scene).starts_with("/scene/load/0/at: a force at x = 2 m would act where the structure is held"));
  scene.load.terms.clear();
  scene.stops.place = StopsSpec::Place::tip;
  CHECK(said(scene).starts_with("/scene/stops/at: the beam is held at both ends and has no tip"));
  // With a stop at all nodes a support lies between the stops.
  scene.stops = {Formula("x<2.5 ? -1 : 0.5", "", "x"), std::nullopt, StopsSpec::Place::nodes, {}};
  scene.initial.displacement = Formula("x<2.5 ? 0 : 1", "", "x");
  CHECK(said(scene).find("beyond the support p3 at 0 m") != std::string::npos);
  scene = held_beam(3, {sliding("a", 0)});
  scene.support = {0.1, 3, 0};
  CHECK(said(scene).starts_with("/scene/support/amplitude: no support of the beam would move it"));
}
