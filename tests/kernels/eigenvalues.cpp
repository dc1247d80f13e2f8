#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <ricochet/kernels/eigenvalues.hpp>

using namespace ricochet;
using Eigen::MatrixXd;

namespace eigenvalues_tests {

// What n roundings of a backward-stable method may leave, relative to the matrix.
constexpr double round_off = 1e-13;

TEST_CASE("symmetric modes satisfy A φ = λ B φ and φᵀBφ = 1, ascending, without vectors the values are bitwise the same") {
  std::srand(7);
  const int n = 12;
  const MatrixXd X = MatrixXd::Random(n, n), Y = MatrixXd::Random(n, n);
  const MatrixXd A = X + X.transpose(), B = Y * Y.transpose() + MatrixXd::Identity(n, n);
  for (const bool general : {false, true}) {
    const SymmetricModes modes = general ? symmetric_modes(A, B) : symmetric_modes(A);
    const MatrixXd metric = general ? B : MatrixXd(MatrixXd::Identity(n, n));
    REQUIRE(modes.found);
    CHECK((A * modes.vectors - metric * modes.vectors * modes.values.asDiagonal()).norm() <
          round_off * A.norm() * B.norm());
    CHECK((modes.vectors.transpose() * metric * modes.vectors - MatrixXd::Identity(n, n)).norm() <
          round_off * B.norm());
    for (int i = 1; i < n; ++i) CHECK(modes.values[i - 1] <= modes.values[i]);
    const SymmetricModes bare =
        general ? symmetric_modes(A, B, EigenVectors::none) : symmetric_modes(A, EigenVectors::none);
    CHECK(bare.vectors.size() == 0);
    CHECK((bare.values - modes.values).lpNorm<Eigen::Infinity>() < round_off * A.norm());
  }
}

TEST_CASE("general modes satisfy A φ = λ φ, the roots of a rotation are a conjugate pair on the unit circle") {
  const double turn = 0.3;
  MatrixXd A(2, 2);
  A << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  const GeneralModes modes = general_modes(A);
  REQUIRE(modes.found);
  CHECK(std::abs(modes.values[0]) == Approx(1).epsilon(1e-15));
  CHECK(std::abs(std::arg(modes.values[0])) == Approx(turn).epsilon(1e-14));
  CHECK(std::abs(modes.values[0] - std::conj(modes.values[1])) == 0);
  CHECK((A.cast<std::complex<double>>() * modes.vectors - modes.vectors * modes.values.asDiagonal()).norm() <
        round_off);
  CHECK(general_modes(A, EigenVectors::none).vectors.size() == 0);
}

TEST_CASE("what has no modes says so") {
  MatrixXd A = MatrixXd::Identity(3, 3);
  A(1, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(general_modes(A).found);
  CHECK_FALSE(symmetric_modes(A).found);
}

TEST_CASE("singular values are the lengths of the axes of the image of a ball") {
  MatrixXd A(3, 2);
  A << 3, 0, 0, 4, 0, 0;
  const Eigen::VectorXd values = singular_values(A);
  CHECK(values[0] == Approx(4));
  CHECK(values[1] == Approx(3));
  CHECK(
      (singular_values(Eigen::MatrixXcd(std::complex<double>(0, 1) * A.cast<std::complex<double>>())) - values).norm() <
      round_off);
}

}  // namespace eigenvalues_tests
