#pragma once

// The event-driven reference against semi-analytic figures, closed forms of the continuous beam, and laws that every
// motion obeys.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <ricochet/loader/catalogue.hpp>

#include "tests/places.hpp"

using namespace ricochet;

namespace event_driven_tests {

inline constexpr double pi = std::numbers::pi;
inline constexpr double length = 1.501;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline std::unique_ptr<ReferenceSolver> solver(std::map<std::string, ParameterValue> values = {}) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  REQUIRE(catalogue.require(Role::reference, "event-driven", registry));
  const auto* entry = registry.reference("event-driven");
  REQUIRE(entry);
  for (const auto& spec : entry->manual.parameters)
    if (spec.fallback && !values.contains(spec.key)) values[spec.key] = *spec.fallback;
  return entry->make(Parameters(values));
}

/// Steel tube 10 mm × 0.5 mm, stops ±0.1 m at the tip, u0 = 0.04x², v0 = −2x.
inline ReferenceProblem free_problem(double alpha) {
  const double outer = 0.01, inner = 0.009;
  ReferenceProblem problem;
  problem.structure = "beam";
  problem.length = length;
  problem.stiffness = 2e11 * pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4));
  problem.inertia = 8000 * pi / 4 * (outer * outer - inner * inner);
  problem.damping_stiffness = alpha;
  problem.left_fixed = true;
  problem.support_pulsation = 10;
  problem.displacement = [](double x) { return 0.04 * x * x; };
  problem.velocity = [](double x) { return -2 * x; };
  problem.stops_at_tip = true;
  problem.stop_places = {length};
  problem.lower = [](double) { return -0.1; };
  problem.upper = [](double) { return 0.1; };
  return problem;
}

inline ReferenceProblem still_problem(double alpha) {
  ReferenceProblem problem = free_problem(alpha);
  problem.displacement = problem.velocity = [](double) { return 0.0; };
  return problem;
}

/// From rest in the laboratory, support A₀ sin 10t.
inline ReferenceProblem forced_problem(double amplitude, double alpha) {
  ReferenceProblem problem = still_problem(alpha);
  problem.support_amplitude = amplitude;
  return problem;
}

inline ReferenceProblem without_stops(ReferenceProblem problem) {
  problem.lower = [](double) { return -infinity; };
  problem.upper = [](double) { return infinity; };
  return problem;
}

inline ReferenceMotion solved(const ReferenceProblem& problem, const SampleGrid& grid,
                              const std::map<std::string, ParameterValue>& values = {}) {
  auto result = solver(values)->solve(problem, grid);
  INFO((std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence.text : ""));
  REQUIRE(std::holds_alternative<ReferenceMotion>(result));
  return std::get<ReferenceMotion>(result);
}

inline std::string refused(const ReferenceProblem& problem, const std::map<std::string, ParameterValue>& values = {}) {
  const auto result = solver(values)->solve(problem, {{0, 0.5}, {}, {}});
  return std::holds_alternative<Refusal>(result) ? std::get<Refusal>(result).sentence.text : "";
}

inline std::vector<double> spread(double end, int count) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(end * i / count);
  return times;
}

inline bool mentions(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// First clamped–free mode, φ(L) = 1.
inline constexpr double first_root = 1.8751040687119611664;
inline double first_mode(double x) {
  const double a = first_root * x / length, z = first_root;
  const double sigma = (std::cosh(z) + std::cos(z)) / (std::sinh(z) + std::sin(z));
  return 0.5 * (std::cosh(a) - std::cos(a) - sigma * (std::sinh(a) - std::sin(a)));
}
inline double first_pulsation(const ReferenceProblem& problem) {
  return std::pow(first_root / length, 2) * std::sqrt(problem.stiffness / problem.inertia);
}

/// Undamped steady shape on a support that moves by sin ωt, u = U(x) sin ωt, of the differential equation itself.
struct SteadyShape {
  explicit SteadyShape(const ReferenceProblem& problem)
      : wave(std::sqrt(problem.support_pulsation / std::sqrt(problem.stiffness / problem.inertia))) {
    const double z = wave * length, c = std::cos(z), s = std::sin(z), C = std::cosh(z), S = std::sinh(z);
    // U = a cos + (1 − a) cosh + b (sin − sinh), U'' = U''' = 0 at L.
    const Eigen::Matrix2d ends{{-c - C, -s - S}, {s - S, -c - C}};
    const Eigen::Vector2d solution = ends.inverse() * Eigen::Vector2d(-C, -S);
    a = solution(0);
    b = solution(1);
  }
  double operator()(double x) const {
    const double y = wave * x;
    return a * std::cos(y) + (1 - a) * std::cosh(y) + b * (std::sin(y) - std::sinh(y));
  }
  double wave, a = 0, b = 0;
};

}  // namespace event_driven_tests
