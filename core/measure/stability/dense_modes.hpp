#pragma once
#include <Eigen/Dense>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

/// Above so many dofs, modes cost more than marching.
inline constexpr int most_modal_dofs = 1200;

/// M as a dense matrix (kg), dofs × dofs; BᵀCv⁻¹B where it is kept in factors.
inline Eigen::MatrixXd dense_mass(const Inertia& inertia) {
  if (!inertia.factored()) return Eigen::MatrixXd(inertia.mass);
  const Eigen::MatrixXd B(inertia.coupling), Cv(inertia.velocity_mass);
  return B.transpose() * Cv.ldlt().solve(B);
}

}  // namespace ricochet
