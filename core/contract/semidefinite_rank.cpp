#include <Eigen/SparseCholesky>
#include <ricochet/contract/semidefinite_rank.hpp>

namespace ricochet {

int semidefinite_rank(const SparseMatrix& A) {
  constexpr double zero = 1e-11;
  Eigen::VectorXd scales = A.diagonal();
  for (double& scale : scales) scale = scale > 0 ? 1 / std::sqrt(scale) : 1.0;
  SparseMatrix shift(A.rows(), A.cols());
  shift.setIdentity();
  const SparseMatrix shifted = SparseMatrix(scales.asDiagonal() * A * scales.asDiagonal()) - zero * shift;
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> factors(shifted);
  return static_cast<int>((factors.vectorD().array() > 0).count());
}

int row_rank(const SparseMatrix& B) {
  SparseMatrix scaled = B;
  for (Eigen::Index j = 0; j < scaled.cols(); ++j)
    if (const double norm = scaled.col(j).norm(); norm > 0) scaled.col(j) /= norm;
  return semidefinite_rank(scaled * SparseMatrix(scaled.transpose()));
}

}  // namespace ricochet
