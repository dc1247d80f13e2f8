#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/kernels/quadratic_form.hpp>

#include "tests/eigen.hpp"

using namespace ricochet;

TEST_CASE("the inverse form is that of the dense matrix, bordered or not") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> entry(-1, 1);
  const int n = 9, r = 4;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n), G = Eigen::MatrixXd::Zero(r, n);
  for (int i = 0; i < n; ++i) {
    A(i, i) = 4;
    for (int j = std::max(0, i - 2); j < i; ++j) A(i, j) = A(j, i) = entry(random);
  }
  for (int j = 0; j < r; ++j)
    for (int i = 2 * j; i < std::min(n, 2 * j + 3); ++i) G(j, i) = entry(random);
  const Eigen::MatrixXd Cv = 0.5 * Eigen::MatrixXd::Identity(r, r);
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return entry(random); });
  QuasiDefinite plain{A.sparseView(), {}, {}}, bordered{A.sparseView(), G.sparseView(), Cv.sparseView()};
  CHECK(*InverseForm(plain)(b) == Approx(b.dot(eigen::ldlt_solve(A, b))).epsilon(1e-12));
  const Eigen::MatrixXd whole = A + 2 * G.transpose() * G;
  CHECK(*InverseForm(bordered)(b) == Approx(b.dot(eigen::ldlt_solve(whole, b))).epsilon(1e-12));
  CHECK(*InverseForm(plain)(Eigen::VectorXd::Zero(n)) == 0.0);
  plain.A = Eigen::SparseMatrix<double>(n, n);
  CHECK_FALSE(InverseForm(plain)(b));
}

TEST_CASE("with its border first, a quasi-definite matrix needs no stiffness") {
  const int n = 6;
  Eigen::MatrixXd C = 3 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 1; i < n; ++i) C(i, i - 1) = C(i - 1, i) = 0.7;
  const Eigen::MatrixXd G = 1.5 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (const double stiffness : {0.0, 1e-9, 40.0}) {
    INFO("stiffness " << stiffness);
    for (int i = 0; i + 1 < n; ++i) K.block(i, i, 2, 2) += stiffness * (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
    QuasiDefinite matrix{K.sparseView(), G.sparseView(), C.sparseView(), true};
    const Eigen::MatrixXd whole = K + G.transpose() * eigen::inverse(C) * G;
    const auto found = InverseForm(matrix)(b);
    REQUIRE(found);
    CHECK(*found == Approx(b.dot(eigen::ldlt_solve(whole, b))).epsilon(1e-13));
    matrix.border_first = false;
    if (stiffness == 0) CHECK_FALSE(InverseForm(matrix)(b));
  }
}
