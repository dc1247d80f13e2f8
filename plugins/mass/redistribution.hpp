#pragma once
#include <algorithm>
#include <cmath>
#include <ricochet/contract/plugin.hpp>
#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>

/// \file
/// Mass moved off the dofs where contact acts, by a projection (Khenous, Laborde and Renard 2008, there over the whole
/// mesh).
///
/// With M the consistent mass of the free dofs and X the rigid motions (translation; of a beam rotation, of a bar x):
///
///     min ‖D (M_r − M) D‖_F,  D = diag(M)^{-1/2},     M_r = 0 in the rows and columns of contact dofs,
///     M_r − M sparse as M, and zero beyond `reach` elements from a contact point,     Xᵀ M_r X = Xᵀ M X
///
/// Hence M_r = M° + Σ_ab λ_ab D⁻² ½(X_a X_bᵀ + X_b X_aᵀ) D⁻² on these entries, M° being M without the rows: three
/// multipliers. D makes displacements and rotations weigh the same on any mesh; with one length for both instead, beams
/// have negative eigenvalues.
namespace ricochet {

/// Where a dof stands, and the rigid motions there.
struct RigidMotions {
  Eigen::VectorXd place;
  Eigen::MatrixXd columns;  ///< n × 2: 1 and x, or (1, 0) and (x, 1)
  explicit RigidMotions(const FiniteElementSpace& space) : place(space.dofs), columns(space.dofs, 2) {
    const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
    for (const auto& element : space.elements)
      for (int a = 0; a < space.functions(); ++a) {
        if (element.dof[a] < 0) continue;
        const bool second = hermite ? a >= 2 : a == 1, rotation = hermite && a % 2 == 1;
        const double x = element.left + (second ? element.length : 0);
        place[element.dof[a]] = x;
        columns.row(element.dof[a]) << (rotation ? 0.0 : 1.0), (rotation ? 1.0 : x);
      }
  }
  /// The same motions about x₀, in units of `length`.
  Eigen::MatrixXd about(double x0, double length) const {
    Eigen::MatrixXd moved = columns;
    moved.col(1) = (columns.col(1) - x0 * columns.col(0)) / length;
    return moved;
  }
};

/// Takes the mass off the dofs `empty` (sorted), whose neighbours within `reach` of their places get it, in m;
/// infinite: all. False where they cannot carry it.
inline bool move_mass(SparseMatrix& mass, const RigidMotions& rigid, const std::vector<int>& empty, double reach) {
  const double first = rigid.place[empty.front()], last = rigid.place[empty.back()];
  const double length = std::min(reach, rigid.place.maxCoeff() - rigid.place.minCoeff());
  const Eigen::MatrixXd X = rigid.about((first + last) / 2, length);
  const Eigen::VectorXd diagonal = mass.diagonal();
  const auto is_empty = [&](Eigen::Index i) {
    return std::binary_search(empty.begin(), empty.end(), static_cast<int>(i));
  };
  const auto near = [&](Eigen::Index i) {
    return std::any_of(empty.begin(), empty.end(),
                       [&](int dof) { return std::abs(rigid.place[i] - rigid.place[dof]) <= reach * (1 + 1e-9); });
  };
  // ½(X_a X_bᵀ + X_b X_aᵀ)_ij for ab = 11, 12, 22.
  const auto share = [&](Eigen::Index i, Eigen::Index j) {
    return Eigen::Vector3d(X(i, 0) * X(j, 0), 0.5 * (X(i, 0) * X(j, 1) + X(i, 1) * X(j, 0)), X(i, 1) * X(j, 1));
  };
  Eigen::Vector3d lost = Eigen::Vector3d::Zero();
  Eigen::Matrix3d response = Eigen::Matrix3d::Zero();
  const auto each = [&](auto&& use) {
    for (Eigen::Index j = 0; j < mass.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(mass, j); it; ++it) use(it, is_empty(it.row()) || is_empty(j));
  };
  each([&](const SparseMatrix::InnerIterator& it, bool emptied) {
    const Eigen::Vector3d s = share(it.row(), it.col());
    if (emptied)
      lost += it.value() * s;
    else if (near(it.row()) && near(it.col()))
      response += diagonal[it.row()] * diagonal[it.col()] * s * s.transpose();
  });
  const Eigen::Vector3d lambda = least_norm_solve(response, lost);
  if (!((response * lambda - lost).norm() <= 1e-9 * lost.norm())) return false;
  each([&](SparseMatrix::InnerIterator& it, bool emptied) {
    if (emptied)
      it.valueRef() = 0;
    else if (near(it.row()) && near(it.col()))
      it.valueRef() += diagonal[it.row()] * diagonal[it.col()] * lambda.dot(share(it.row(), it.col()));
  });
  return true;
}

/// Whether a mass without the rows `empty` is positive definite on the others.
inline bool positive_elsewhere(const SparseMatrix& mass, const std::vector<int>& empty) {
  Eigen::VectorXd scale = mass.diagonal();
  if (!(scale.minCoeff() >= 0)) return false;
  for (double& value : scale) value = value > 0 ? 1 / std::sqrt(value) : 1;
  SparseMatrix scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  constexpr double regular = 1e-9;
  for (int i = 0; i < scaled.rows(); ++i)
    scaled.coeffRef(i, i) += std::binary_search(empty.begin(), empty.end(), i) ? 1 : -regular;
  SparseLdlt factors;
  return factors.factorise(scaled) &&
         std::all_of(factors.pivot().begin(), factors.pivot().end(), [](double pivot) { return pivot > 0; });
}

}  // namespace ricochet
