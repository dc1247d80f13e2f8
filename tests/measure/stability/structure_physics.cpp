// What a plan says of a structure, against closed forms.
#include <catch2/catch.hpp>
#include <numbers>
#include <ricochet/measure/stability/structure_physics.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace structure_physics_tests {

namespace {

StructurePhysics physics_of(const SceneSpec& scene, int elements, const char* mass = "consistent") {
  return std::get<StructurePhysics>(structure_physics(scene, elements, *make(registry().mass(mass), {mass})));
}

}  // namespace

TEST_CASE("physics: a beam in two planes has the frequencies of each plane") {
  SceneSpec scene;
  BeamSpec beam;
  beam.section = {.type = Section::Type::given, .EI = 1, .rhoS = 1, .EI_z = 4};
  beam.planes = 2;
  scene.structure = beam;
  const StructurePhysics physics = physics_of(scene, 10);
  // ω grows with √EI.
  CHECK(physics.pulsations[1] == Approx(2 * physics.pulsations[0]).epsilon(1e-9));
  REQUIRE(physics.details.size() >= 2);
  CHECK_THAT(physics.details[1], Catch::Contains("dofs: 40, held 4; two planes"));
  beam.section = {.type = Section::Type::rectangle, .width = 2, .height = 1};
  beam.young = beam.density = 12;
  scene.structure = beam;
  const std::vector<PhysicalNumber> numbers = physics_of(scene, 10).numbers;
  REQUIRE(numbers.size() == 1);
  CHECK(numbers[0].value == Approx(8));  // E h b³/12
}

TEST_CASE("physics: the frequencies of a cantilever are β²√(EI/ρSL⁴), whatever the mass matrix") {
  SceneSpec scene;
  BeamSpec beam;
  beam.length = 1.501;
  beam.young = 2e11;
  beam.density = 8000;
  beam.section = {.type = Section::Type::tube, .outer_diameter = 0.01, .wall = 0.0005};
  beam.damping = {.stiffness = 1e-4, .mass = 0.5};
  scene.structure = beam;
  const SectionProperties section = section_properties(beam.section, beam.young, beam.density);
  const double scale = std::sqrt(section.EI / section.rhoS) / beam.length / beam.length;
  for (const char* mass : {"consistent", "singular"}) {
    INFO(mass);
    const StructurePhysics physics = physics_of(scene, 40, mass);
    CHECK(physics.structure == "beam");
    const double roots[] = {1.8751040687, 4.6940911330, 7.8547574382};  // of cos β cosh β = −1
    for (std::size_t i = 0; i < 3; ++i) {
      const double omega = physics.pulsations[i];
      CHECK(omega == Approx(roots[i] * roots[i] * scale).epsilon(1e-3));  // 40 elements, order 2 at worst
      CHECK(*physics.damping_ratio(i) == Approx((1e-4 * omega + 0.5 / omega) / 2));
    }
  }
}

TEST_CASE("physics: a beam on supports of its own says what holds it, its mesh and its held dofs") {
  BeamSpec beam;
  beam.length = 3;
  beam.section = {.type = Section::Type::given, .EI = 1, .rhoS = 1};
  beam.supports.emplace();
  for (const double x : {0.0, 1.0})
    beam.supports->push_back({.name = x == 0 ? "a" : "b", .x = x, .type = BeamSupport::Type::pinned});
  beam.supports->push_back({.name = "c", .x = 3, .type = BeamSupport::Type::elastic, .stiffness = 1e3, .rotation = 5});
  beam.masses = {{.x = 2, .mass = 0.5, .inertia = 0}};
  SceneSpec scene;
  scene.structure = beam;
  CHECK(physics_of(scene, 12).details ==
        std::vector<std::string>{"elements: 4 from 0 to 1 m, 4 from 1 to 2 m, 4 from 2 to 3 m", "dofs: 24, held 2",
                                 "static modes of the supports sum to 1: moved together they carry every point along"});
  // Held nowhere, it translates and turns.
  beam.supports->clear();
  beam.masses.clear();
  scene.structure = beam;
  const StructurePhysics free = physics_of(scene, 12);
  CHECK(free.details.front() == "2 rigid motions");
  CHECK(free.pulsations[1] == 0);
  CHECK(free.pulsations[2] == Approx(std::pow(4.730040745 / 3, 2)).epsilon(1e-4));  // (kℓ)⁴/1440 of 12 elements
  beam.supports.reset();
  scene.structure = beam;
  CHECK(physics_of(scene, 12).details.empty());
}

TEST_CASE("physics: a step resolves the modes that have so many steps in their period") {
  SceneSpec scene;
  scene.structure = BarSpec{};  // ω_i = (i − ½)π
  const StructurePhysics physics = physics_of(scene, 100);
  CHECK_FALSE(physics.damping_ratio(0).has_value());
  const double h = 0.01;
  const int count = physics.resolved(h, 20);
  REQUIRE(count > 0);
  CHECK(2 * std::numbers::pi / physics.pulsations[static_cast<std::size_t>(count - 1)] >= 20 * h);
  CHECK(2 * std::numbers::pi / physics.pulsations[static_cast<std::size_t>(count)] < 20 * h);
  CHECK(count == 10);  // (i − ½)π ≤ 10π
  CHECK(physics.resolved(100, 20) == 0);
}

TEST_CASE("physics: at its stops a cantilever has 3EI/x³, and one that nothing holds has no stiffness") {
  BeamSpec beam;
  beam.section.type = Section::Type::given;
  beam.section.EI = 1;
  beam.section.rhoS = 1;
  SceneSpec scene;
  scene.structure = beam;
  scene.stops.upper = Formula(1.0);
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.5, 1};
  const std::vector<double> stiffness = physics_of(scene, 4).point_stiffness;
  REQUIRE(stiffness.size() == 2);
  CHECK(stiffness[0] == Approx(24).epsilon(1e-10));
  CHECK(stiffness[1] == Approx(3).epsilon(1e-10));
  BarSpec bar;
  bar.fixed = BarSpec::Fixed::none;
  scene.structure = bar;
  CHECK(physics_of(scene, 4).point_stiffness.empty());
}

TEST_CASE(
    "physics: an oscillator has one mode, a bar held nowhere a rigid one, and a fine mesh is looked at on fewer") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 100, .stiffness = 1e4, .damping = 200, .force = {}};
  const StructurePhysics one = physics_of(scene, 1);
  REQUIRE(one.pulsations.size() == 1);
  CHECK(one.pulsations[0] == Approx(10));
  CHECK(*one.damping_ratio(0) == Approx(200 / (2 * std::sqrt(1e4 * 100))));  // c/2√(km)
  BarSpec bar;
  bar.fixed = BarSpec::Fixed::none;
  bar.damping.stiffness = 1e-3;
  scene.structure = bar;
  const StructurePhysics free = physics_of(scene, 1000);
  CHECK(free.elements < 1000);
  CHECK(free.pulsations[0] == 0);
  CHECK_FALSE(free.damping_ratio(0).has_value());
  CHECK(free.pulsations[1] == Approx(std::numbers::pi).epsilon(1e-3));
}

}  // namespace structure_physics_tests
