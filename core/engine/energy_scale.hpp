#pragma once
#include <ricochet/algebra/inverse_form.hpp>
#include <ricochet/algebra/quadratic_form.hpp>
#include <ricochet/engine/compile.hpp>
#include <vector>

namespace ricochet {

/// The energies (J) that a scene's data mention, by which a march knows that it has diverged.
class EnergyScale {
 public:
  explicit EnergyScale(const SemiDiscrete& problem);

  /// Of one lane, whoever marches beside it: the largest of ½ qᵀKq + ½ vᵀMv of its initial state, the static response
  /// to the clamp's inertia forces A ω² and to resting on each stop, and the kinetic energy of the clamp's speed A ω.
  double of_lane(const LaneSpec& lane) const;

  /// The largest static energy ½ Fᵀ K⁻¹ F of the distributed load at evenly spaced times up to t (s); infinite where
  /// nothing holds the structure back, so that no energy is too large; 0 without a load.
  double of_load(double t) const;

 private:
  double static_energy(const Eigen::VectorXd& load) const;

  const SemiDiscrete* problem_;
  QuadraticForm mass_, stiffness_;
  InverseForm compliance_;
  double support_energy_ = 0;        // of a clamp acceleration of 1 m/s²
  double support_mass_ = 0;          // moved by a clamp speed of 1 m/s
  std::vector<double> stop_energy_;  // of each contact point pushed aside by 1 m; 0 where K is singular
};

}  // namespace ricochet
