#include "tests/eigen.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace eigen {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd ldlt_solve(const MatrixXd& A, const VectorXd& b) {
  return A.ldlt().solve(b);
}

MatrixXd ldlt_solve_all(const MatrixXd& A, const MatrixXd& B) {
  return A.ldlt().solve(B);
}

VectorXd lu_solve(const MatrixXd& A, const VectorXd& b) {
  return A.fullPivLu().solve(b);
}

MatrixXd inverse(const MatrixXd& A) {
  return A.inverse();
}

bool is_definite(const MatrixXd& A) {
  return A.llt().info() == Eigen::Success;
}

Eigen::Index rank(const MatrixXd& A) {
  return A.colPivHouseholderQr().rank();
}

MatrixXd orthogonal(const MatrixXd& A) {
  return Eigen::HouseholderQR<MatrixXd>(A).householderQ();
}

VectorXd values(const MatrixXd& A) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Modes modes(const MatrixXd& A, const MatrixXd& B) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> found(A, B);
  return {found.eigenvalues(), found.eigenvectors()};
}

}  // namespace eigen
