// What a spring behind a stop turns back.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/stability/linear_response.hpp>

#include "tests/marching.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace contact_spring_tests {

TEST_CASE("a stiff spring behind the tip turns back the mass of the last node, where masses are lumped") {
  const SceneSpec scene = working_set();
  for (const int elements : {4, 10}) {
    const auto problem = problem_of(scene, elements, {"lumped"});
    const double end = dense_mass(problem->inertia).diagonal().maxCoeff() / 2;  // half of an inner node's
    CAPTURE(elements, end);
    for (const double stiffness : {1e9, 1e10, 1e12}) {
      const auto spring = contact_spring(*problem, stiffness);
      REQUIRE(spring);
      CHECK(spring->stiffness == stiffness);
      CHECK(spring->mass == Approx(end).epsilon(1e-3));
      // The structure behind it, 12 EI/ℓ³ of one element at most, is soft beside it.
      CHECK(spring->pulsation == Approx(std::sqrt(stiffness / end)).epsilon(1e-3));
    }
  }
}

TEST_CASE("a soft spring turns back what the first mode moves, and adds to its own stiffness") {
  const SceneSpec scene = working_set();
  const auto problem = problem_of(scene, 10, {"consistent"});
  const auto soft = contact_spring(*problem, 1e-3), stiffer = contact_spring(*problem, 2e-3);
  REQUIRE((soft && stiffer));
  // ω² = (k + κ)/m of one mode, k and m its own at the tip: ¼ of the beam's mass for a clamped beam (φ²(L) = 4 of the
  // normalised first mode).
  const auto& beam = std::get<BeamSpec>(scene.structure);
  const double mass = section_properties(beam.section, beam.young, beam.density).rhoS * beam.length / 4;
  const double rise = stiffer->pulsation * stiffer->pulsation - soft->pulsation * soft->pulsation;
  CHECK(1e-3 / rise == Approx(mass).epsilon(1e-3));
}

TEST_CASE("where the point has no mass, no mode is found on its spring") {
  const SceneSpec scene = working_set();
  const auto problem = problem_of(scene, 10, {"singular"});
  CHECK_FALSE(contact_spring(*problem, 1e12));
}

}  // namespace contact_spring_tests
