// Kernels against plain loops, for each instruction set and each number of lanes.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/algebra/band_ldlt.hpp>
#include <ricochet/algebra/block.hpp>
#include <ricochet/algebra/lane_kernels.hpp>

using namespace ricochet;

namespace {

Block random_block(int rows, int lanes, int border, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Block block(rows, lanes, border);
  for (int i = 0; i < rows; ++i)
    for (int l = 0; l < lanes; ++l) block.at(i, l) = uniform(engine);
  return block;
}

SparseMatrix random_band(int n, int width, bool definite) {
  std::mt19937 engine(static_cast<unsigned>(n * 31 + width));
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Triplet<double>> triplets;
  for (int i = 0; i < n; ++i)
    for (int j = i; j < std::min(n, i + width + 1); ++j) {
      const double value = i == j && definite ? 2.5 * (width + 1) : uniform(engine);
      triplets.emplace_back(i, j, value);
      if (i != j) triplets.emplace_back(j, i, value);
    }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

}  // namespace

TEST_CASE("a band step solves S z = K k + M m + shape·scale + load") {
  const int T = GENERATE(1, 2, 4, 8, 16, 32), width = GENERATE(0, 1, 2, 3, 5);
  const bool baseline = GENERATE(false, true), full = GENERATE(false, true);
  const int n = 23;
  const SparseMatrix K = random_band(n, width, false), M = random_band(n, width, false);
  QuasiDefinite S;
  S.A = random_band(n, width, true);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(S));
  const Block k = random_block(n, T, width, 1), m = random_block(n, T, width, 2), scale = random_block(1, T, 0, 3);
  std::vector<double> shape(n), load(n);
  for (int i = 0; i < n; ++i) {
    shape[static_cast<std::size_t>(i)] = std::cos(i);
    load[static_cast<std::size_t>(i)] = std::sin(2 * i);
  }
  const auto bands = band_storage(K, width, T == 1), masses = band_storage(M, width, T == 1);
  Block b(n, T), z(n, T, ldlt.half_width());
  BandStep step;
  step.rows = step.solve_rows = n;
  step.product_width = width;
  step.solve_width = ldlt.half_width();
  step.K = bands.data();
  step.k = k.data();
  step.shape = shape.data();
  step.scale = scale.data();
  if (full) {
    step.M = masses.data();
    step.m = m.data();
    step.load = load.data();
  }
  step.factor = ldlt.factor();
  step.b = b.data();
  step.z = z.data();
  lane_kernels(T, baseline).band_step(step);
  const Eigen::MatrixXd dense_K = K, dense_M = M, dense_S = S.A;
  for (int l = 0; l < T; ++l) {
    Eigen::VectorXd a(n), c(n), rhs(n), found(n);
    for (int i = 0; i < n; ++i) {
      a[i] = k.at(i, l);
      c[i] = m.at(i, l);
      found[i] = z.at(i, l);
      rhs[i] = shape[static_cast<std::size_t>(i)] * scale.at(0, l) + (full ? load[static_cast<std::size_t>(i)] : 0);
    }
    rhs += dense_K * a;
    if (full) rhs += dense_M * c;
    // S is diagonally dominant: its condition is a small number.
    CHECK((dense_S.ldlt().solve(rhs) - found).lpNorm<Eigen::Infinity>() < 1e-13);
  }
}

TEST_CASE("the two instruction sets agree to round-off, and updates follow their weights") {
  const int T = GENERATE(1, 4, 32), n = 9;
  for (const bool increments : {false, true}) {
    // The second set of weights is the one that the kernels recognise: q ← q + d + z, d ← d + z.
    const std::vector<double> weights =
        increments ? std::vector<double>{1, 1, 1, 0, 1, 1} : std::vector<double>{0.5, 1, 2, 0.1, -1, 3};
    const std::vector<double> next = {0.3, -0.7};
    const Block q = random_block(n, T, 0, 5), d = random_block(n, T, 0, 6), z = random_block(n, T, 0, 7);
    for (const bool baseline : {false, true}) {
      Block x = q, y = d, combined(n, T);
      double* slots[] = {x.data(), y.data()};
      lane_kernels(T, baseline)
          .update(static_cast<long>(x.size()), 2, slots, z.data(), weights.data(), next.data(), combined.data());
      for (std::size_t e = 0; e < x.size(); ++e) {
        const double new_q = weights[0] * q.data()[e] + weights[1] * d.data()[e] + weights[2] * z.data()[e];
        const double new_d = weights[3] * q.data()[e] + weights[4] * d.data()[e] + weights[5] * z.data()[e];
        REQUIRE(x.data()[e] == Approx(new_q).margin(1e-15));
        REQUIRE(y.data()[e] == Approx(new_d).margin(1e-15));
        REQUIRE(combined.data()[e] == Approx(next[0] * new_q + next[1] * new_d).margin(1e-15));
      }
    }
  }
}

TEST_CASE("a lane is outside when any of its points is, or is no number") {
  const int T = GENERATE(1, 2, 8, 32);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const bool baseline : {false, true}) {
    Block y(3, T), lower(3, T), upper(3, T);
    lower.fill(-1);
    upper.fill(infinity);
    const auto& kernels = lane_kernels(T, baseline);
    CHECK(kernels.outside(3, y.data(), lower.data(), upper.data()) == 0);
    y.at(2, T - 1) = -1;
    CHECK(kernels.outside(3, y.data(), lower.data(), upper.data()) == 0);
    y.at(2, T - 1) = -1.5;
    CHECK(kernels.outside(3, y.data(), lower.data(), upper.data()) == 1u << (T - 1));
    y.at(0, 0) = std::nan("");
    CHECK((kernels.outside(3, y.data(), lower.data(), upper.data()) & 1u) == 1u);
  }
}

TEST_CASE("a quasi-definite system equals its Schur complement, and a singular one is refused") {
  const int n = 12, border = 6;
  QuasiDefinite system;
  system.A = random_band(n, 3, true);
  std::vector<Eigen::Triplet<double>> coupling;
  for (int r = 0; r < border; ++r)
    for (int j = std::max(0, 2 * r - 2); j < std::min(n, 2 * r + 4); ++j)
      coupling.emplace_back(r, j, j == 2 * r ? 1.0 : 0.2);
  system.G = SparseMatrix(border, n);
  system.G.setFromTriplets(coupling.begin(), coupling.end());
  system.Cv = random_band(border, 1, true);
  BandLdlt ldlt;
  REQUIRE_FALSE(ldlt.factorise(system));
  CHECK(ldlt.half_width() == 5);
  const Eigen::MatrixXd A = system.A, G = system.G, Cv = system.Cv;
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2),
                        expected = (A + G.transpose() * Cv.inverse() * G).ldlt().solve(b);
  std::vector<int> from = ldlt.order();
  for (int& row : from)
    if (row >= n) row = -1;
  Block z(ldlt.rows(), 1, ldlt.half_width());
  Eigen::VectorXd rhs = b;
  BandStep step;
  step.solve_rows = ldlt.rows();
  step.solve_width = ldlt.half_width();
  step.factor = ldlt.factor();
  step.from = from.data();
  step.b = rhs.data();
  step.z = z.data();
  lane_kernels(1).band_step(step);
  for (int r = 0; r < ldlt.rows(); ++r)
    if (ldlt.order()[static_cast<std::size_t>(r)] < n)
      CHECK(z.data()[r] == Approx(expected[ldlt.order()[static_cast<std::size_t>(r)]]).margin(1e-13));

  QuasiDefinite singular;
  singular.A = SparseMatrix(3, 3);
  singular.A.insert(0, 0) = 1;
  CHECK(ldlt.factorise(singular)->find("singular") != std::string::npos);
}
