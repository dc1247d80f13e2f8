#pragma once
#include <ricochet/engine/compile.hpp>
#include <ricochet/kernels/quadratic_form.hpp>
#include <vector>

namespace ricochet {

/// The energies (J) that a scene's data mention, by which an integration knows that it has diverged.
class EnergyScale {
 public:
  explicit EnergyScale(const SemiDiscrete& problem);

  /// Of one lane, whoever marches beside it: the largest of several energies. One is ½ qᵀKq + ½ vᵀMv of its initial
  /// state, one the kinetic energy of the clamp's speed A ω. The others are of static responses: to the clamp's inertia
  /// forces A ω², and to resting on each stop.
  double of_lane(const LaneSpec& lane) const;

  /// The largest static energy ½ Fᵀ K⁻¹ F of the distributed load at evenly spaced times up to t (s). Infinite where
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

/// Energies (J) beyond which lanes count as diverged: a multiple of what the scene's own data mention; infinite where
/// the program is not bounded.
class EnergyBounds {
 public:
  static constexpr double factor = 1e9;  ///< of EnergyScale

  explicit EnergyBounds(const Program& program);

  /// `stored`: by the law in the lane's initial state, J.
  void place(int lane, const LaneSpec& spec, double stored);
  /// A lane's own, whoever marches beside it; infinite where the scene mentions no energy.
  double of(int lane) const;
  /// Whether an energy at time t is beyond it; samples a load that depends on time before it says so.
  bool passed(int lane, double energy, double t);

 private:
  double known(int lane) const;

  EnergyScale scale_;
  bool bounded_;
  bool load_varies_;           // with time
  std::vector<double> lanes_;  // without the load
  double load_ = 0, load_known_until_ = 0;
};

}  // namespace ricochet
