// Which impacts with inertia a step resolves.
#include <ricochet/measure/orbits/impact_jump.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("an oscillator's impact is resolved where hω is at most a tenth") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{2, 50, 0, {}};  // ω = 5
  scene.stops.lower = Formula(-1.0);
  scene.stops.place = StopsSpec::Place::tip;
  const auto problem = problem_of(scene, 1, {"consistent"});
  CHECK(resolved_points(*problem, 0.0999 / 5) == std::vector<bool>{true});
  CHECK(resolved_points(*problem, 0.1001 / 5) == std::vector<bool>{false});
  scene.structure = OscillatorSpec{2, 0, 0, {}};  // a free mass goes on as it was pushed
  CHECK(resolved_points(*problem_of(scene, 1, {"consistent"}), 10) == std::vector<bool>{true});
}

TEST_CASE("the mass of one node of a beam needs steps below those of central differences") {
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const Choice mass = GENERATE(Choice{"consistent"}, Choice{"lumped"});
  const int elements = 20;
  const auto problem = problem_of(scene, elements, mass);
  // 2/ω of the highest mode of the consistent mass; an impulse on a node moves about the upper half of the modes.
  const double length = 1.501 / elements, limit = 0.0334014193 * length * length / std::sqrt(282.8125);
  const std::vector<bool> all(static_cast<std::size_t>(elements), true),
      none(static_cast<std::size_t>(elements), false);
  INFO(mass.name);
  CHECK(resolved_points(*problem, limit / 40) == all);
  CHECK(resolved_points(*problem, 4 * limit) == none);
  // Points without mass never are: what they move in an instant vanishes with the instant.
  CHECK(resolved_points(*problem_of(scene, elements, {"singular"}), limit / 40) != all);
}
