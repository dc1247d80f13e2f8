#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <ricochet/kernels/dense_solvers.hpp>

namespace ricochet {
namespace {

using Eigen::MatrixXd;

template <class Matrix, class Vector>
std::optional<Vector> fully_pivoted(const Matrix& A, const Vector& b) {
  const Eigen::FullPivLU<Matrix> lu(A);
  if (!lu.isInvertible()) return std::nullopt;
  return lu.solve(b).eval();
}

}  // namespace

MatrixXd householder_basis(const MatrixXd& A) {
  return Eigen::HouseholderQR<MatrixXd>(A).householderQ();
}

MatrixXd householder_columns(const MatrixXd& A) {
  return Eigen::HouseholderQR<MatrixXd>(A).householderQ() * MatrixXd::Identity(A.rows(), A.cols());
}

PivotedBasis pivoted_basis(const MatrixXd& A) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
  return {qr.householderQ(), qr.rank()};
}

bool is_definite(const MatrixXd& A) {
  return Eigen::LLT<MatrixXd>(A).info() == Eigen::Success;
}

MatrixXd definite_solve(const MatrixXd& A, const MatrixXd& B) {
  return A.llt().solve(B);
}

MatrixXd cholesky_forward(const MatrixXd& A, const MatrixXd& B) {
  return A.llt().matrixL().solve(B);
}

struct DenseLu::Factors {
  Eigen::PartialPivLU<MatrixXd> lu;
};

DenseLu::DenseLu() : factors_(std::make_unique<Factors>()) {}
DenseLu::DenseLu(const MatrixXd& A) : DenseLu() {
  compute(A);
}
DenseLu::DenseLu(DenseLu&&) noexcept = default;
DenseLu& DenseLu::operator=(DenseLu&&) noexcept = default;
DenseLu::~DenseLu() = default;

void DenseLu::compute(const MatrixXd& A) {
  factors_->lu.compute(A);
}

MatrixXd DenseLu::solve(const MatrixXd& B) const {
  return factors_->lu.solve(B);
}

MatrixXd inverse(const MatrixXd& A) {
  return Eigen::PartialPivLU<MatrixXd>(A).inverse();
}

Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& A) {
  return Eigen::PartialPivLU<Eigen::MatrixXcd>(A).inverse();
}

double determinant(const MatrixXd& A) {
  return A.determinant();
}

Eigen::VectorXd pivoted_solve(const MatrixXd& A, const Eigen::VectorXd& b) {
  return Eigen::FullPivLU<MatrixXd>(A).solve(b);
}

Eigen::VectorXcd pivoted_solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  return Eigen::FullPivLU<Eigen::MatrixXcd>(A).solve(b);
}

std::optional<Eigen::VectorXd> regular_solve(const MatrixXd& A, const Eigen::VectorXd& b) {
  return fully_pivoted(A, b);
}

std::optional<Eigen::VectorXcd> regular_solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  return fully_pivoted(A, b);
}

Eigen::VectorXd least_squares(const MatrixXd& A, const Eigen::VectorXd& b) {
  return A.colPivHouseholderQr().solve(b);
}

MatrixXd least_norm_solve(const MatrixXd& A, const MatrixXd& B) {
  return A.completeOrthogonalDecomposition().solve(B);
}

}  // namespace ricochet
