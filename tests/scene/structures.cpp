// Oscillator and bar: their matrices, places and refusals. Motion is checked against closed forms in tests/engine.
#include <ricochet/scene/assembly.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

SceneSpec oscillator(double stiffness = 4) {
  SceneSpec scene;
  scene.structure = OscillatorSpec{.mass = 2, .stiffness = stiffness, .damping = 0.6, .force = {}};
  scene.stops.lower = Formula(-0.5);
  scene.stops.place = StopsSpec::Place::tip;
  scene.initial.displacement = Formula(0.3);
  scene.initial.velocity = Formula(-1.0);
  return scene;
}

SceneSpec bar(BarSpec::Fixed fixed) {
  SceneSpec scene;
  scene.structure = BarSpec{.length = 2, .EA = 3, .rhoA = 5, .fixed = fixed, .damping = {}};
  scene.stops.lower = Formula(-1.0);
  scene.stops.place = StopsSpec::Place::nodes;
  return scene;
}

}  // namespace

TEST_CASE("an oscillator is one mass, one spring, one point") {
  const SemiDiscrete problem = discretised(oscillator(), 1, *mass("consistent"));
  REQUIRE(problem.dofs() == 1);
  CHECK(dense_mass(problem.inertia)(0, 0) == 2);
  CHECK(problem.stiffness.coeff(0, 0) == 4);
  CHECK(problem.damping.mass * 2 == Approx(0.6));  // C = ηM = c
  REQUIRE(problem.points() == 1);
  CHECK(problem.contact.coeff(0, 0) == 1);
  CHECK(problem.tip.coeff(0, 0) == 1);
  CHECK(problem.position[0] == 0.3);
  CHECK(problem.velocity[0] == -1);
  // All mass strategies that need elements say so, or give the same single mass.
  CHECK(dense_mass(discretised(oscillator(), 1, *mass("lumped")).inertia)(0, 0) == 2);
  const auto refused = discretise(oscillator(), 1, *mass("singular"));
  REQUIRE(std::holds_alternative<Refusal>(refused));
}

TEST_CASE("an oscillator's force and its load add up") {
  SceneSpec scene = oscillator();
  std::get<OscillatorSpec>(scene.structure).force = {.amplitude = 3, .pulsation = 2, .phase = 0.4};
  scene.load = Formula("7*t", "/scene/load", "xt");
  const SemiDiscrete problem = discretised(scene, 1, *mass("consistent"));
  for (const double t : {0.0, 0.3, 5.0}) {
    double force = 0;
    problem.load->assemble(t, &force);
    CHECK(force == Approx(7 * t + 3 * std::cos(2 * t + 0.4)).epsilon(1e-14));
  }
}

TEST_CASE("an oscillator has no mesh and no further places for stops") {
  CHECK(input_error([] { make_space(oscillator().structure, 3); }) ==
        "/mesh/elements: 3 elements; an oscillator has no mesh: expected 1");
  SceneSpec scene = oscillator();
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.5};
  CHECK(input_error([&] { check_scene(scene, 1); }).starts_with("/scene/stops/at:"));
  scene = oscillator();
  std::get<OscillatorSpec>(scene.structure).mass = 0;
  CHECK(input_error([&] { check_scene(scene, 1); }).starts_with("/scene/structure/mass:"));
}

TEST_CASE("a bar's matrices are those of linear elements, whichever end is held") {
  for (const auto fixed : {BarSpec::Fixed::right, BarSpec::Fixed::left, BarSpec::Fixed::none}) {
    const int elements = 8;
    const SemiDiscrete problem = discretised(bar(fixed), elements, *mass("consistent"));
    CHECK(problem.dofs() == (fixed == BarSpec::Fixed::none ? elements + 1 : elements));
    CHECK(problem.points() == problem.dofs());  // a contact point at every free node
    const auto places = dof_places(problem.space);
    Eigen::VectorXd linear(problem.dofs());
    for (int i = 0; i < problem.dofs(); ++i) linear[i] = places[static_cast<std::size_t>(i)].x;
    // A uniform strain of one has the energy ½ EA L; held at x = L, that strain is x − L.
    if (fixed == BarSpec::Fixed::right) linear.array() -= 2;
    CHECK(linear.dot(problem.stiffness * linear) == Approx(3.0 * 2).epsilon(1e-13));
    // The tip is the free end.
    CHECK(places[static_cast<std::size_t>(Eigen::SparseMatrix<double>(problem.tip.transpose()).innerIndexPtr()[0])].x ==
          (fixed == BarSpec::Fixed::left ? 2.0 : 0.0));
    for (const auto& [dof, value] : strain_row(problem.space, 0.9)) CHECK(std::abs(value) == Approx(elements / 2.0));
  }
}

TEST_CASE("frequencies of a bar converge with order 2: consistent from above, lumped from below") {
  const double exact = std::pow(3.14159265358979323846 / 4, 2) * 3 / 5;  // ω² = (π/2L)² EA/ρA, L = 2
  for (const std::string name : {"consistent", "lumped"}) {
    std::vector<double> x, y;
    for (const int elements : {8, 16, 32, 64}) {
      const SemiDiscrete problem = discretised(bar(BarSpec::Fixed::right), elements, *mass(name));
      const double square = 1 / compliances(problem.stiffness, problem.inertia).maxCoeff();
      CHECK((square - exact) * (name == "consistent" ? 1 : -1) > 0);
      x.push_back(std::log(1.0 / elements));
      y.push_back(std::log(std::abs(square - exact)));
    }
    // The next term of the series is ℓ⁴: 0.01 at 8 elements.
    CHECK(fitted_slope(x, y) == Approx(2).margin(0.01));
  }
}

TEST_CASE("a bar's clamp moves with the support, and a free bar has none") {
  SceneSpec scene = bar(BarSpec::Fixed::none);
  scene.support = {.amplitude = 0.1, .pulsation = 3, .phase = 0};
  CHECK(input_error([&] { check_scene(scene, 4); }).starts_with("/scene/support/amplitude:"));
  scene = bar(BarSpec::Fixed::right);
  scene.stops.lower = Formula("x-1", "/scene/stops/lower", "x");  // at the clamp, x = 2: 1 m, above the rest position
  CHECK(input_error([&] { check_scene(scene, 4); }).starts_with("/scene/stops/lower: the lower stop at x = 2"));
  scene = bar(BarSpec::Fixed::right);
  scene.stops.place = StopsSpec::Place::positions;
  scene.stops.positions = {0.0};
  CHECK(discretised(scene, 4, *mass("consistent")).points() == 1);  // its free end
  scene.stops.positions = {2.0};
  CHECK(input_error([&] { check_scene(scene, 4); }).starts_with("/scene/stops/at/0:"));
}

TEST_CASE("stops may meet, and may not cross") {
  SceneSpec scene = oscillator();
  scene.initial = {};
  scene.stops.lower = Formula(0.0);
  scene.stops.upper = Formula(0.0);
  check_scene(scene, 1);
  scene.stops.lower = Formula(1e-9);
  CHECK(input_error([&] { check_scene(scene, 1); }).starts_with("/scene/stops/lower:"));
}
