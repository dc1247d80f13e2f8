#include "pencil.hpp"

#include <ricochet/kernels/dense_solvers.hpp>
#include <ricochet/kernels/eigenvalues.hpp>

namespace ricochet::reference {

Pencil pencil(const LinearStructure& structure, const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& closed) {
  const Eigen::Index n = structure.dofs(), a = closed.rows();
  const Eigen::MatrixXd whole = stiffness + structure.shift * structure.mass;
  // Springs may be far stiffer than the structure: the dof they act on is scaled by them.
  const Eigen::VectorXd scale = whole.diagonal().cwiseSqrt().cwiseInverse();
  const auto S = scale.asDiagonal();
  const Eigen::MatrixXd M = S * structure.mass * S, K = S * whole * S;
  Eigen::MatrixXd kept = Eigen::MatrixXd::Identity(n, n);
  if (a > 0) {
    const Eigen::MatrixXd across = (closed * S).transpose();
    kept = householder_basis(across).rightCols(n - a);
  }
  Pencil result;
  result.shapes.resize(n, 0);
  result.massless.resize(n, 0);
  if (kept.cols() == 0) return result;
  // The kernel is judged where springs have no part in it.
  const Eigen::VectorXd ratio = scale.cwiseQuotient(structure.scale);
  const Eigen::MatrixXd plain = householder_columns(ratio.asDiagonal() * kept);
  const auto P = structure.scale.asDiagonal();
  const Eigen::MatrixXd light = P * structure.mass * P;
  const SymmetricModes inertia = symmetric_modes(plain.transpose() * light * plain);
  const Eigen::Index k = (inertia.values.array() <= 1e-11 * light.diagonal().maxCoeff()).count();
  if (k > 0) {
    const Eigen::MatrixXd Z = ratio.cwiseInverse().asDiagonal() * (plain * inertia.vectors.leftCols(k));
    const Eigen::MatrixXd massless = cholesky_forward(Z.transpose() * K * Z, Z.transpose()).transpose();
    result.massless = S * massless;
    const Eigen::MatrixXd pulled = kept.transpose() * (K * massless);
    const Eigen::MatrixXd turned = householder_basis(pulled);
    kept = (kept * turned.rightCols(kept.cols() - k)).eval();
  }
  if (kept.cols() == 0) return result;
  const SymmetricModes moving = symmetric_modes(kept.transpose() * M * kept, kept.transpose() * K * kept);
  const Eigen::VectorXd mu = moving.values;
  result.shapes = S * (kept * (moving.vectors * mu.cwiseSqrt().cwiseInverse().asDiagonal()));
  result.squares = mu.cwiseInverse().array() - structure.shift;
  for (double& square : result.squares)
    if (square < 1e-9 * structure.shift) square = 0;
  return result;
}

}  // namespace ricochet::reference
