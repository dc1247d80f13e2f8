#pragma once
#include <numbers>
#include <ricochet/measure/orbits/periodic_map.hpp>

#include "tests/marching.hpp"

/// \file
/// The steel tube that is shaken at 10 rad/s between stops at its tip: maps of one forcing period, over the amplitude.
namespace ricochet::testing {

inline constexpr double tube_pulsation = 10;

inline SceneSpec shaken_tube(double amplitude) {
  SceneSpec scene = working_set();
  beam_of(scene).damping.stiffness = 1e-4;
  scene.support = {amplitude, tube_pulsation, 0};
  scene.initial.displacement = Formula(0.0);
  scene.initial.velocity = Formula(0.0);
  return scene;
}

inline Methods tube_methods() {
  Methods methods;
  methods.mass.values["velocity"] = std::string("P1");
  return methods;
}

inline Program tube_program(double amplitude, int steps, int elements = 10, const Methods& methods = tube_methods()) {
  CompileOptions options;
  options.moving_support = true;
  auto program = compiled(problem_of(shaken_tube(amplitude), elements, methods.mass, methods.contact), methods,
                          2 * std::numbers::pi / tube_pulsation / steps, options);
  REQUIRE(std::holds_alternative<Program>(program));
  return std::move(std::get<Program>(program));
}

inline PeriodicMap tube_map(int steps, int elements = 10, const Methods& methods = tube_methods()) {
  const Program low = tube_program(0.05, steps, elements, methods), high = tube_program(0.1, steps, elements, methods);
  const auto lanes = affine_lane(low.lanes[0], 0.05, high.lanes[0], 0.1);
  REQUIRE(lanes);
  return PeriodicMap(tube_program(0.08, steps, elements, methods), *lanes, {1.0, tube_pulsation});
}

/// The state that so many periods from rest lead to.
inline Eigen::VectorXd settled_tube(PeriodicMap& map, double amplitude, int steps, int periods = 300, int elements = 10,
                                    const Methods& methods = tube_methods()) {
  LaneEnd end;
  const auto state = settle(tube_program(amplitude, steps, elements, methods), steps, periods, end);
  REQUIRE(state);
  return map.vector().read(*state);
}

}  // namespace ricochet::testing
