// Laws of the dense factorisations, on random matrices of fixed seeds. Tolerances: some hundred round-offs of the sizes
// that occur.
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/kernels/dense_solvers.hpp>

using namespace ricochet;
using Eigen::MatrixXd;

namespace dense_solvers_tests {
namespace {

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

const MatrixXd unit = MatrixXd::Identity(6, 6);

}  // namespace

TEST_CASE("dense: Q is orthogonal, and its first columns span those of A") {
  const MatrixXd A = random_matrix(6, 3, 1), Q = householder_basis(A), columns = householder_columns(A);
  CHECK((Q.transpose() * Q - unit).norm() < 1e-13);
  CHECK((Q.leftCols(3) - columns).norm() < 1e-13);
  CHECK((A - columns * (columns.transpose() * A)).norm() < 1e-13);
}

TEST_CASE("dense: pivoting finds the rank, and what is orthogonal to A") {
  MatrixXd A = random_matrix(6, 4, 2);
  A.col(2) = A.col(0) - 2 * A.col(3);
  const PivotedBasis found = pivoted_basis(A);
  CHECK(found.rank == 3);
  CHECK((found.basis.rightCols(3).transpose() * A).norm() < 1e-13);
  CHECK(pivoted_basis(unit).rank == 6);
}

TEST_CASE("dense: definite problems") {
  const MatrixXd B = random_matrix(6, 2, 3), R = random_matrix(6, 6, 4), A = R * R.transpose() + unit;
  CHECK(is_definite(A));
  CHECK_FALSE(is_definite(A - 1e3 * unit));
  CHECK((A * definite_solve(A, B) - B).norm() < 1e-12);
  const MatrixXd half = cholesky_forward(A, B);
  CHECK((half.transpose() * half - B.transpose() * definite_solve(A, B)).norm() < 1e-12);
}

TEST_CASE("dense: general problems, and those of no full rank") {
  const MatrixXd A = random_matrix(6, 6, 5), B = random_matrix(6, 2, 6);
  const DenseLu lu(A);
  CHECK((A * lu.solve(B) - B).norm() < 1e-11);
  CHECK_FALSE(DenseLu(MatrixXd::Zero(6, 6)).solve(B).allFinite());
  const Eigen::MatrixXcd C = A + std::complex<double>(0, 1) * unit;
  CHECK((C * inverse(C) - unit).norm() < 1e-11);

  const Eigen::VectorXd b = B.col(0);
  REQUIRE(regular_solve(A, b));
  CHECK((A * *regular_solve(A, b) - b).norm() < 1e-11);
  REQUIRE(regular_solve(C, Eigen::VectorXcd(b)));
  MatrixXd singular = A;
  singular.row(5) = singular.row(0) + singular.row(1);
  CHECK_FALSE(regular_solve(singular, b));
  CHECK_FALSE(regular_solve(Eigen::MatrixXcd(singular), Eigen::VectorXcd(b)));

  // The least of all X that solve it best. No part of it lies in the kernel of A, and the remainder is orthogonal to
  // the columns of A.
  const MatrixXd X = least_norm_solve(singular, B), left = B - singular * X;
  CHECK((singular.transpose() * left).norm() < 1e-11);
  const MatrixXd kernel = pivoted_basis(singular.transpose()).basis.rightCols(1);
  CHECK((kernel.transpose() * X).norm() < 1e-11);
}

}  // namespace dense_solvers_tests
