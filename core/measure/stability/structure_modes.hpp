#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>

namespace ricochet {

/// Above so many dofs, modes cost more than marching.
constexpr int most_modal_dofs = 1200;

/// Modes of M φ = μ K φ, slowest first, those of Ker M last.
struct StructureModes {
  Eigen::MatrixXd shapes;  ///< one column per mode
  Eigen::VectorXd mass, stiffness;
  int regular = 0;  ///< modes with mass

  /// `kernel`: the dimension of Ker M; `free`: K is singular.
  StructureModes(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, int kernel, bool free);

  int size() const { return static_cast<int>(mass.size()); }
  /// rad/s; 0 on Ker M.
  double pulsation(int i) const { return i < regular ? std::sqrt(std::max(0.0, stiffness[i] / mass[i])) : 0.0; }
  std::string name(int i) const;
};

/// The modes of a problem whose contact is open.
StructureModes open_modes(const SemiDiscrete& problem);
/// Those of the structure with H_J q = 0; `free`: without this, K is singular.
StructureModes held_modes(const SemiDiscrete& problem, const std::vector<int>& points, bool free);

}  // namespace ricochet
