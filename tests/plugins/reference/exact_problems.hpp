#pragma once

// Closed forms: the impact oscillator and the bar of period 3, against laws that they obey.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/loader/catalogue.hpp>

#include "tests/places.hpp"

using namespace ricochet;

namespace exact_tests {

inline const ReferenceSolver& exact() {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  static const std::unique_ptr<ReferenceSolver> solver = [] {
    REQUIRE(catalogue.require(Role::reference, "exact", registry));
    return registry.reference("exact")->make(Parameters());
  }();
  return *solver;
}

inline SampledMotion solved(const ReferenceProblem& problem, const SampleGrid& grid) {
  auto found = exact().solve(problem, grid);
  INFO((std::holds_alternative<Refusal>(found) ? std::get<Refusal>(found).sentence.text : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(found));
  SampledMotion motion = std::get<ReferenceMotion>(std::move(found)).motion;
  CHECK(motion.tip.size() == grid.times.size());
  CHECK(motion.tip_velocity.size() == grid.times.size());
  CHECK(motion.energy.size() == grid.times.size());
  CHECK(motion.impulse.size() == grid.times.size());
  CHECK(motion.displacement.size() == grid.times.size() * grid.places.size());
  return motion;
}

inline std::string refusal(const ReferenceProblem& problem) {
  const auto found = exact().solve(problem, {{0, 1}, {}, {}});
  const auto* refused = std::get_if<Refusal>(&found);
  return refused ? refused->sentence.text : std::string();
}

inline std::vector<double> times(double end, int count) {
  std::vector<double> result;
  for (int i = 0; i <= count; ++i) result.push_back(end * i / count);
  return result;
}

inline std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

/// Unit mass, without stops, at rest.
inline ReferenceProblem oscillator(double stiffness) {
  ReferenceProblem problem;
  problem.structure = "oscillator";
  problem.inertia = 1;
  problem.stiffness = stiffness;
  problem.displacement = problem.velocity = constant(0);
  problem.lower = constant(-INFINITY);
  problem.upper = constant(INFINITY);
  problem.stop_places = {0};
  problem.stops_at_tip = true;
  return problem;
}

inline void push(ReferenceProblem& problem, double load) {
  problem.load_zero = false;
  problem.load = [load](double, double) { return load; };
}

/// m w'' + c w' + k w = F cos(ωt + ψ) + load − m φ'' by the classical fourth-order method: u and u' at `end`.
inline std::array<double, 2> by_small_steps(const ReferenceProblem& problem, double end, int steps) {
  const double A = problem.support_amplitude, pulsation = problem.support_pulsation;
  const auto turn = [&](double t) { return pulsation * t + problem.support_phase; };
  const double viscosity = problem.damping_mass * problem.inertia + problem.damping_stiffness * problem.stiffness;
  const auto slope = [&](double t, std::array<double, 2> x) {
    double force = problem.force_amplitude * std::cos(problem.force_pulsation * t + problem.force_phase);
    if (problem.load) force += problem.load(0, t);
    force += problem.inertia * A * pulsation * pulsation * std::sin(turn(t));
    return std::array{x[1], (force - viscosity * x[1] - problem.stiffness * x[0]) / problem.inertia};
  };
  const auto moved = [](std::array<double, 2> x, double h, std::array<double, 2> k) {
    return std::array{x[0] + h * k[0], x[1] + h * k[1]};
  };
  std::array<double, 2> x{problem.displacement(0) - A * std::sin(turn(0)),
                          problem.velocity(0) - A * pulsation * std::cos(turn(0))};
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const auto k1 = slope(t, x), k2 = slope(t + h / 2, moved(x, h / 2, k1)), k3 = slope(t + h / 2, moved(x, h / 2, k2)),
               k4 = slope(t + h, moved(x, h, k3));
    for (int j = 0; j < 2; ++j) x[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  return {x[0] + A * std::sin(turn(end)), x[1] + A * pulsation * std::cos(turn(end))};
}

}  // namespace exact_tests
