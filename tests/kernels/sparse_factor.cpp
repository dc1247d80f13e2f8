// Matrices of no narrow band: one factor for all who ask, and forms that keep the digits of an energy.
#include <Eigen/Core>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <ricochet/kernels/quadratic_form.hpp>
#include <ricochet/kernels/sparse_factor.hpp>

#include "tests/eigen.hpp"

using namespace ricochet;

namespace {

// Second differences of second differences on a square grid, held at its edge: the stiffness of a membrane of beams.
SparseMatrix grid(int side) {
  const auto at = [&](int i, int j) { return side * i + j; };
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      entries.emplace_back(at(i, j), at(i, j), 4.0);
      for (const auto& [a, b] : {std::pair(i + 1, j), {i - 1, j}, {i, j + 1}, {i, j - 1}})
        if (a >= 0 && b >= 0 && a < side && b < side) entries.emplace_back(at(i, j), at(a, b), -1.0);
    }
  SparseMatrix once(side * side, side * side);
  once.setFromTriplets(entries.begin(), entries.end());
  return once * once;
}

Eigen::VectorXd some_vector(Eigen::Index n, double phase) {
  return Eigen::VectorXd::NullaryExpr(n,
                                      [&](Eigen::Index i) { return std::sin(1.3 * static_cast<double>(i) + phase); });
}

}  // namespace

TEST_CASE("forms of a matrix of no narrow band are those of its dense one, by its factor and by its rows") {
  const SparseMatrix K = grid(13);
  const Eigen::MatrixXd dense(K);
  const Eigen::VectorXd x = some_vector(K.rows(), 0.1), y = some_vector(K.rows(), 0.7);
  for (const QuadraticForm& form : {QuadraticForm(K), QuadraticForm(K).by_rows(), QuadraticForm::by_rows(K)}) {
    // Sums of some thousand terms of one size.
    CHECK(form(x.data()) == Approx(x.dot(dense * x)).epsilon(1e-12));
    CHECK(form(x.data(), y.data()) == Approx(x.dot(dense * y)).epsilon(1e-12));
    CHECK_FALSE(form.squares());
    CHECK_FALSE(form.unit());
  }
  // One that is not definite has rows alone.
  const SparseMatrix indefinite = K - SparseMatrix(30.0 * Eigen::VectorXd::Ones(K.rows()).asDiagonal());
  CHECK(QuadraticForm(indefinite)(x.data()) == Approx(x.dot(indefinite * x)).epsilon(1e-12));
}

TEST_CASE("squares by a factor read the energy of a smooth shape without the noise of A x") {
  // x = sin·sin is a mode of the grid: xᵀA x = λ² |x|² with λ of second differences, 10⁻⁷ of the entries of A.
  constexpr int side = 99;
  const SparseMatrix K = grid(side);
  Eigen::VectorXd x(K.rows());
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      x[side * i + j] =
          std::sin(std::numbers::pi * (i + 1) / (side + 1)) * std::sin(std::numbers::pi * (j + 1) / (side + 1));
  const double half = std::sin(std::numbers::pi / (2 * (side + 1))), lambda = 8 * half * half;
  const double exact = lambda * lambda * x.squaredNorm();
  // Whatever x is scaled by, its energy is the same but for what evaluation adds.
  const auto noise = [&](const QuadraticForm& form) {
    double least = exact, most = 0;
    for (int k = 0; k < 20; ++k) {
      const double scale = 1 + 0.013 * k;
      const Eigen::VectorXd scaled = scale * x;
      const double one = form(scaled.data()) / (scale * scale);
      least = std::min(least, one);
      most = std::max(most, one);
    }
    return (most - least) / exact;
  };
  const QuadraticForm squares(K), rows = QuadraticForm::by_rows(K);
  // Round-off of A is 2·10⁻¹⁶ of entries of 20, over λ² = 4·10⁻⁶.
  CHECK(squares(x.data()) == Approx(exact).epsilon(1e-9));
  CHECK(rows(x.data()) == Approx(exact).epsilon(1e-9));
  CHECK(noise(squares) < 1e-12);
  CHECK(noise(rows) < 1e-9);
  CHECK(noise(squares) < noise(rows));
}

TEST_CASE("equal matrices share a factor for as long as somebody holds it") {
  const SparseMatrix K = grid(11);
  auto first = SparseFactor::of(K);
  REQUIRE(first);
  CHECK(first->positive());
  const SparseMatrix same = K;
  CHECK(SparseFactor::of(same) == first);
  SparseMatrix other = K;
  other.coeffRef(0, 0) *= 1 + 1e-15;
  CHECK(SparseFactor::of(other) != first);
  const std::weak_ptr<const SparseFactor> held = first;
  first.reset();
  CHECK(held.expired());
  CHECK_FALSE(SparseFactor::of(SparseMatrix(20, 20)));
}

TEST_CASE("an inverse of no narrow band is that of the dense matrix, and none of an indefinite one") {
  const SparseMatrix K = grid(12);
  const Eigen::VectorXd b = some_vector(K.rows(), 0.4);
  const InverseForm inverse(QuasiDefinite{K, {}, {}});
  const Eigen::VectorXd expected = eigen::ldlt_solve(Eigen::MatrixXd(K), b);
  REQUIRE(inverse(b));
  // The condition number is 10⁴.
  CHECK(*inverse(b) == Approx(b.dot(expected)).epsilon(1e-10));
  CHECK((*inverse.solve(b) - expected).norm() <= 1e-10 * expected.norm());
  const SparseMatrix negative = -K;
  CHECK_FALSE(InverseForm(QuasiDefinite{negative, {}, {}})(b));
}
