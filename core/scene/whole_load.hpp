#pragma once
#include <ricochet/scene/scene.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// A force F cos(ωt + ψ) on an oscillator.
struct HarmonicForce {
  HarmonicTerm force;
  std::string body;     ///< whose it is; empty: the scene has one structure
  std::string pointer;  ///< where the scene says it
};

/// The forces of the oscillators of a scene, those of amplitude 0 among them.
std::vector<HarmonicForce> harmonic_forces(const SceneSpec& scene);

/// The load of a scene with the forces of its oscillators, each as one more term.
LoadSpec whole_load(const SceneSpec& scene);

/// Whether anything but its initial state moves a scene: a load, the force of an oscillator, supports or stops that
/// move.
bool is_driven(const SceneSpec& scene);

}  // namespace ricochet
