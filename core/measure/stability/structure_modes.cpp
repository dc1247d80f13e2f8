#include <fmt/format.h>

#include <ricochet/algebra/dense_solvers.hpp>
#include <ricochet/algebra/eigenvalues.hpp>
#include <ricochet/algebra/sparse_ldlt.hpp>
#include <ricochet/measure/stability/structure_modes.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

std::string StructureModes::name(int i) const {
  if (i >= regular) return "the kernel of the mass";
  return fmt::format("mode {} of {} ({:.4g} rad/s)", i + 1, regular, pulsation(i));
}

StructureModes::StructureModes(const MatrixXd& M, const MatrixXd& K, int kernel, bool free) {
  const Index n = M.rows();
  if (kernel == 0 && is_definite(M)) {
    // The fast modes, which limit steps, are the accurate ones here.
    const SymmetricModes eigen = symmetric_modes(K, M);
    shapes = eigen.vectors;
    stiffness = eigen.values.cwiseMax(0.0);
    if (free)
      for (double& k : stiffness)
        if (k < 1e-11 * stiffness.maxCoeff()) k = 0;
    mass = VectorXd::Ones(n);
    regular = static_cast<int>(n);
    return;
  }
  // (K + σM) is definite whenever M and K share no kernel.
  const double shift = free ? std::max(K.trace(), 1e-300) / M.trace() / static_cast<double>(n * n) : 0.0;
  const SymmetricModes eigen = symmetric_modes(M, K + shift * M);
  shapes = eigen.vectors.rowwise().reverse();
  mass = eigen.values.reverse().cwiseMax(0.0);
  regular = static_cast<int>(n) - kernel;
  mass.tail(kernel).setZero();
  stiffness = VectorXd::Ones(n) - shift * mass;
  for (double& k : stiffness)
    if (k < 1e-11) k = 0;
}

StructureModes open_modes(const SemiDiscrete& problem) {
  SparseLdlt ldlt;
  const bool free = !ldlt.factorise(problem.stiffness);
  return {dense_mass(problem.inertia), MatrixXd(problem.stiffness), problem.inertia.kernel_dimension, free};
}

StructureModes held_modes(const SemiDiscrete& problem, const std::vector<int>& points, bool free) {
  const Index n = problem.dofs();
  MatrixXd rows(static_cast<Index>(points.size()), n);
  for (Index i = 0; i < rows.rows(); ++i)
    rows.row(i) = Eigen::RowVectorXd(problem.measured().row(points[static_cast<std::size_t>(i)]));
  const PivotedBasis pivoted = pivoted_basis(rows.transpose());
  const MatrixXd basis = pivoted.basis.rightCols(n - pivoted.rank);
  int kernel = 0;
  if (problem.inertia.kernel_dimension > 0) {
    const MatrixXd kernel_rows = rows * mass_kernel(problem.inertia);
    kernel = static_cast<int>(kernel_rows.cols() - pivoted_basis(kernel_rows).rank);
  }
  const MatrixXd M = basis.transpose() * dense_mass(problem.inertia) * basis;
  const MatrixXd K = basis.transpose() * MatrixXd(problem.stiffness) * basis;
  StructureModes held(M, K, kernel, free);
  held.shapes = basis * held.shapes;
  return held;
}

}  // namespace ricochet
