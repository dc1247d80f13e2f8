#pragma once
#include <numbers>
#include <ricochet/scene/beam.hpp>

#include "tests/scene/working_set.hpp"

/// \file
/// Beams held otherwise than by a clamp at 0, and their pulsations.
namespace ricochet::testing {

inline const BeamSpec& beam_of(const SceneSpec& scene) {
  return std::get<BeamSpec>(scene.structure);
}

/// EI = ρA = 1 on a length, without stops and at rest.
inline SceneSpec held_beam(double length, std::vector<BeamSupport> supports) {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  beam_of(scene).length = length;
  beam_of(scene).supports = std::move(supports);
  return scene;
}

inline BeamSupport pinned(const std::string& name, double x) {
  return {.name = name, .x = x, .type = BeamSupport::Type::pinned};
}
inline BeamSupport clamped(const std::string& name, double x) {
  return {.name = name, .x = x, .type = BeamSupport::Type::clamped};
}
inline BeamSupport sliding(const std::string& name, double x) {
  return {.name = name, .x = x, .type = BeamSupport::Type::sliding};
}
inline BeamSupport elastic(const std::string& name, double x, double stiffness, double rotation = 0) {
  return {.name = name, .x = x, .type = BeamSupport::Type::elastic, .stiffness = stiffness, .rotation = rotation};
}

/// Pinned at 0, 1, …, n.
inline std::vector<BeamSupport> pinned_at_each(int spans) {
  std::vector<BeamSupport> supports;
  for (int i = 0; i <= spans; ++i) supports.push_back(pinned("p" + std::to_string(i), i));
  return supports;
}

/// ω of the problem, ascending.
inline Eigen::VectorXd pulsations(const SemiDiscrete& problem) {
  const Eigen::VectorXd mu = compliances(problem.stiffness, problem.inertia);
  Eigen::VectorXd out(mu.size() - problem.inertia.kernel_dimension);
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = 1 / std::sqrt(mu[mu.size() - 1 - i]);
  return out;
}
inline Eigen::VectorXd pulsations(const SceneSpec& scene, int elements, const std::string& name = "consistent") {
  return pulsations(discretised(scene, elements, *mass(name)));
}

}  // namespace ricochet::testing
