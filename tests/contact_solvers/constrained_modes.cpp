#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/kernels/eigenvalues.hpp>

using namespace ricochet;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace constrained_modes_tests {

// What some n roundings leave of numbers of size 1.
constexpr double round_off = 1e-13;

void check_laws(const VectorXd& mass, const MatrixXd& rows) {
  const ConstrainedModes modes = constrained_modes(mass, rows);
  const Index m = mass.size() - rows.rows();
  REQUIRE(modes.basis.cols() == m);
  REQUIRE(modes.mass.size() == m);
  const MatrixXd& basis = modes.basis;
  CHECK((rows * basis).cwiseAbs().maxCoeff() < round_off * rows.norm());
  CHECK((basis.transpose() * basis - MatrixXd::Identity(m, m)).cwiseAbs().maxCoeff() < round_off);
  // Each pair of modes in the size of its own masses: the lightest are known as well as the heaviest.
  const MatrixXd coupled = basis.transpose() * mass.asDiagonal() * basis;
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < m; ++j) {
      CAPTURE(i, j, modes.mass[i], modes.mass[j]);
      if (i == j)
        CHECK(std::abs(coupled(i, i) - modes.mass[i]) <= round_off * modes.mass[i] + 1e-16 * 1e-16 * mass.maxCoeff());
      else
        CHECK(std::abs(coupled(i, j)) <= round_off * std::max(modes.mass[i], modes.mass[j]));
    }
  for (Index i = 1; i < m; ++i) CHECK(modes.mass[i - 1] <= modes.mass[i]);
  // The same structure by its null space and a symmetric solver.
  const MatrixXd Q = rows.transpose().colPivHouseholderQr().householderQ();
  const MatrixXd null = Q.rightCols(m);
  const SymmetricModes dense = symmetric_modes(null.transpose() * mass.asDiagonal() * null, EigenVectors::none);
  CHECK((dense.values - modes.mass).lpNorm<Eigen::Infinity>() < round_off * mass.maxCoeff());
}

// Masses of a cantilever whose K is 1: 1/ω² over eleven decades, heaviest first; rows as its modes are at a point.
VectorXd beam_masses(Index n) {
  VectorXd mass(n);
  for (Index j = 0; j < n; ++j) mass[j] = std::pow(static_cast<double>(j) + 0.6, -4);
  return mass;
}
MatrixXd point_rows(Index points, Index n) {
  MatrixXd rows(points, n);
  for (Index i = 0; i < points; ++i)
    for (Index j = 0; j < n; ++j)
      rows(i, j) = std::sin((static_cast<double>(j) + 0.5) * (1.0 + 0.37 * static_cast<double>(i))) *
                   std::pow(static_cast<double>(j) + 0.6, -2);
  return rows;
}

TEST_CASE("constrained modes hold their points, are orthogonal, and diagonalise the mass, each to its own size") {
  for (const Index n : {2, 3, 7, 40, 200})
    for (const Index points : {1, 2, 5}) {
      if (points >= n) continue;
      CAPTURE(n, points);
      check_laws(beam_masses(n), point_rows(points, n));
    }
}

TEST_CASE("masses that coincide, a kernel of many massless modes among them, and modes that the point does not see") {
  std::srand(11);
  VectorXd mass(12);
  mass << 0, 0, 0, 0, 1e-9, 1e-9 * (1 + 1e-15), 1e-4, 0.5, 0.5, 1, 1, 2;
  MatrixXd rows = MatrixXd::Random(2, 12);
  check_laws(mass, rows.topRows(1));
  check_laws(mass, rows);
  rows(0, 2) = rows(0, 6) = rows(0, 11) = 0;
  rows(0, 7) = 1e-200;
  check_laws(mass, rows);
  rows.row(0).setZero();
  rows(0, 3) = 1;  // holds one mode alone
  check_laws(mass, rows.topRows(1));
}

TEST_CASE("a mode that a point hardly sees keeps its mass but for the square of that") {
  VectorXd mass(3);
  mass << 1, 2, 4;
  MatrixXd row(1, 3);
  row << 1, 1e-7, 1;
  const ConstrainedModes modes = constrained_modes(mass, row);
  // Nearest to it, f(2 + δ) = −c²/δ + Σ_others = 0.
  const double others = 1.0 / (1.0 - 2.0) + 1.0 / (4.0 - 2.0), shift = 1e-14 / others;
  CHECK((modes.mass.array() - 2).cwiseAbs().minCoeff() == Approx(std::abs(shift)).epsilon(0.1));
  CHECK(modes.basis.col(0).dot(modes.basis.col(1)) == Approx(0).margin(1e-15));
}

}  // namespace constrained_modes_tests
