#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <ricochet/loader/catalogue.hpp>

#include "tests/places.hpp"

/// \file
/// The continuous steel tube of the studies, shaken at its clamp between stops at its tip, and its event-driven map.
namespace ricochet::testing {

inline constexpr double beam_length = 1.501, beam_pulsation = 10, beam_gap = 0.1;

/// Clamp A sin 10t, stops ±0.1 m, α = 1e-4 s; at rest in the laboratory.
inline ReferenceProblem continuous_beam(double amplitude) {
  constexpr double outer = 0.01, inner = 0.009, young = 2e11, density = 8000;
  const double second = std::numbers::pi / 64 * (std::pow(outer, 4) - std::pow(inner, 4));
  ReferenceProblem problem;
  problem.structure = "beam";
  problem.length = beam_length;
  problem.stiffness = young * second;
  problem.inertia = density * std::numbers::pi / 4 * (outer * outer - inner * inner);
  problem.damping_stiffness = 1e-4;
  problem.left_fixed = true;
  problem.support_amplitude = amplitude;
  problem.support_pulsation = beam_pulsation;
  problem.displacement = problem.velocity = [](double) { return 0.0; };
  problem.stops_at_tip = true;
  problem.stop_places = {beam_length};
  problem.lower = [](double) { return -beam_gap; };
  problem.upper = [](double) { return beam_gap; };
  return problem;
}

inline std::unique_ptr<ReferenceSolver> beam_solver(int modes) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  REQUIRE(catalogue.require(Role::reference, "event-driven", registry));
  const auto* entry = registry.reference("event-driven");
  std::map<std::string, ParameterValue> values = {{"modes", static_cast<long long>(modes)}};
  for (const auto& spec : entry->manual.parameters)
    if (spec.fallback && !values.contains(spec.key)) values[spec.key] = *spec.fallback;
  return entry->make(Parameters(values));
}

inline std::unique_ptr<ReferenceMap> beam_map(const ReferenceProblem& problem, int modes) {
  auto made = beam_solver(modes)->map(problem);
  REQUIRE(std::holds_alternative<std::unique_ptr<ReferenceMap>>(made));
  return std::get<std::unique_ptr<ReferenceMap>>(std::move(made));
}

}  // namespace ricochet::testing
