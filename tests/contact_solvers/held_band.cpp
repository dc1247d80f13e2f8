#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <ricochet/contact_solvers/held_band.hpp>

#include "tests/allocations.hpp"
#include "tests/eigen.hpp"

namespace held_band_tests {

using namespace ricochet;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Rows of H: unit rows and short ones, side by side.
struct Rows {
  std::vector<int> start{0}, index;
  std::vector<double> value;
  void add(std::vector<int> columns, std::vector<double> values) {
    index.insert(index.end(), columns.begin(), columns.end());
    value.insert(value.end(), values.begin(), values.end());
    start.push_back(static_cast<int>(index.size()));
  }
  int size() const { return static_cast<int>(start.size()) - 1; }
  LaneRows view() const { return {size(), start.data(), index.data(), value.data()}; }
  MatrixXd dense(int columns) const {
    MatrixXd H = MatrixXd::Zero(size(), columns);
    for (int i = 0; i < size(); ++i)
      for (int e = start[static_cast<std::size_t>(i)]; e < start[static_cast<std::size_t>(i) + 1]; ++e)
        H(i, index[static_cast<std::size_t>(e)]) += value[static_cast<std::size_t>(e)];
    return H;
  }
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * uniform_(engine_); }

  /// SPD of half-bandwidth w, diagonally dominant; with a border of r rows, quasi-definite.
  QuasiDefinite band(int n, int w, int r) {
    MatrixXd A = MatrixXd::Zero(n, n), G = MatrixXd::Zero(r, n), C = MatrixXd::Zero(r, r);
    for (int i = 0; i < n; ++i) {
      A(i, i) = 2.2 * w + 1;
      for (int j = std::max(0, i - w); j < i; ++j) A(i, j) = A(j, i) = (*this)(-1, 1);
    }
    for (int k = 0; k < r; ++k) {
      C(k, k) = (*this)(0.5, 2);
      const int first = k * (n - 3) / std::max(1, r);
      for (int j = first; j < first + 3; ++j) G(k, j) = (*this)(-1, 1);
    }
    return {A.sparseView(), G.sparseView(), C.sparseView(), false};
  }
  Rows points(int n) {
    Rows rows;
    for (int i = 1; i + 3 < n; i += 2) {
      if (i % 3 == 0)
        rows.add({i - 1, i, i + 1, i + 2}, {(*this)(-1, 1), (*this)(0.5, 1), (*this)(-1, 1), (*this)(-1, 1)});
      else
        rows.add({i}, {1.0});
    }
    return rows;
  }
  VectorXd vector(int n) {
    return VectorXd::NullaryExpr(n, [&] { return (*this)(-1, 1); });
  }
  /// Some points held without compliance, some with, the others not.
  VectorXd compliance(int m) {
    return VectorXd::NullaryExpr(m, [&] {
      const double u = (*this)(0, 1);
      return u < 0.4 ? 0.0 : u < 0.6 ? (*this)(0, 2) : infinity;
    });
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

MatrixXd delassus(const QuasiDefinite& S, const MatrixXd& H) {
  MatrixXd whole(S.A);
  if (S.G.rows() > 0) whole += MatrixXd(S.G).transpose() * eigen::inverse(S.Cv) * MatrixXd(S.G);
  return H * eigen::ldlt_solve_all(whole, H.transpose());
}

VectorXd held_efforts(const MatrixXd& W, const VectorXd& c, const VectorXd& r) {
  std::vector<int> set;
  for (int i = 0; i < c.size(); ++i)
    if (c[i] < infinity) set.push_back(i);
  VectorXd p = VectorXd::Zero(c.size());
  const MatrixXd A = W(set, set) + MatrixXd(VectorXd(c(set)).asDiagonal());
  const VectorXd efforts = eigen::ldlt_solve(A, r(set));
  p(set) = efforts;
  return p;
}

}  // namespace

TEST_CASE("points held in a band push as those of the dense operator", "[held]") {
  Random random(1);
  for (const int border : {0, 9})
    for (const int width : {0, 1, 3, 7, 11}) {
      constexpr int n = 60;
      const QuasiDefinite S = random.band(n, width, border);
      const Rows H = random.points(n);
      const int m = H.size();
      const MatrixXd W = delassus(S, H.dense(n));
      const auto band = HeldBand::make(S, H.view());
      REQUIRE(band);
      INFO("border " << border << " width " << width);
      // Conditions below 100.
      const double close = 1e3 * n * epsilon;
      for (int j = 0; j < m; ++j) CHECK(band->diagonal(j) == Approx(W(j, j)).epsilon(close));
      for (int repeat = 0; repeat < 20; ++repeat) {
        const VectorXd c = random.compliance(m), r = random.vector(m);
        VectorXd p(m), y(m);
        band->hold(c.data());
        band->solve(r.data(), p.data());
        const VectorXd expected = held_efforts(W, c, r);
        CHECK((p - expected).norm() <= close * expected.norm());
        band->multiply(p.data(), y.data());
        CHECK((y - W * p).norm() <= close * (W * p).norm());
        const int free = static_cast<int>(std::find(c.begin(), c.end(), infinity) - c.begin());
        if (free == m) continue;
        band->solve_column(free, p.data());
        const VectorXd answer = held_efforts(W, c, W.col(free));
        CHECK((p - answer).norm() <= close * answer.norm());
      }
    }
}

TEST_CASE("a band that held other sets before gives bitwise what a new one gives", "[held]") {
  Random random(2);
  constexpr int n = 80;
  const QuasiDefinite S = random.band(n, 3, 12);
  Rows H = random.points(n);
  // One place twice: the second of them is dropped whenever both are held.
  H.add({5}, {1.0});
  H.add({41}, {1.0});
  const int m = H.size();
  const auto used = HeldBand::make(S, H.view());
  VectorXd c = random.compliance(m);
  for (int repeat = 0; repeat < 200; ++repeat) {
    // Few points change, as between two sets of a search.
    for (int k = 0; k < 1 + repeat % 4; ++k) {
      const int i = repeat % 5 == 0 ? m - 1 - k % 2 : static_cast<int>(random(0, m - 1e-9));
      c[i] = c[i] < infinity ? infinity : 0.0;
    }
    const auto fresh = HeldBand::make(S, H.view());
    const VectorXd r = random.vector(m);
    VectorXd p(m), q(m);
    used->hold(c.data());
    fresh->hold(c.data());
    used->solve(r.data(), p.data());
    fresh->solve(r.data(), q.data());
    CHECK(p == q);
    for (int i = 0; i < m; ++i) CHECK(used->dropped(i) == fresh->dropped(i));
  }
}

TEST_CASE("points that depend on others, or that nothing moves, are dropped while they do", "[held]") {
  Random random(3);
  constexpr int n = 30;
  const QuasiDefinite S = random.band(n, 3, 0);
  Rows H;
  for (const int dof : {4, 11, 4, 20}) H.add({dof}, {1.0});
  H.add({}, {});
  const auto band = HeldBand::make(S, H.view());
  const MatrixXd W = delassus(S, H.dense(n));
  VectorXd c = VectorXd::Zero(5), r = random.vector(5), p(5);
  band->hold(c.data());
  CHECK(band->dropped(0) + band->dropped(2) == 1);
  CHECK(band->dropped(4));
  CHECK_FALSE(band->dropped(1));
  band->solve(r.data(), p.data());
  const int first = band->dropped(0) ? 2 : 0, second = 2 - first;
  CHECK(p[second] == 0);
  CHECK(p[4] == 0);
  VectorXd alone = c;
  alone[second] = alone[4] = infinity;
  CHECK((p - held_efforts(W, alone, r)).norm() <= 1e-12 * p.norm());
  // With a spring between them both push.
  c[0] = c[2] = 0.5;
  c[4] = infinity;
  band->hold(c.data());
  CHECK_FALSE(band->dropped(0));
  CHECK_FALSE(band->dropped(2));
  band->solve(r.data(), p.data());
  CHECK((p - held_efforts(W, c, r)).norm() <= 1e-12 * p.norm());
  // And the first alone again.
  c[0] = 0;
  c[2] = infinity;
  band->hold(c.data());
  CHECK_FALSE(band->dropped(0));
}

TEST_CASE("what is no narrow band, or has no factor, holds no points", "[held]") {
  Random random(4);
  Rows far;
  far.add({0, 90}, {1.0, 1.0});
  CHECK_FALSE(HeldBand::make(random.band(100, 2, 0), far.view()));
  Rows one;
  one.add({0}, {1.0});
  QuasiDefinite singular = random.band(10, 1, 0);
  singular.A *= 0;
  CHECK_FALSE(HeldBand::make(singular, one.view()));
}

TEST_CASE("holding and solving allocate nothing", "[held]") {
  Random random(5);
  constexpr int n = 60;
  const QuasiDefinite S = random.band(n, 3, 8);
  const Rows H = random.points(n);
  const int m = H.size();
  const auto band = HeldBand::make(S, H.view());
  VectorXd r = random.vector(m), p(m), c = random.compliance(m);
  const long before = allocations();
  for (int repeat = 0; repeat < 10; ++repeat) {
    c[repeat] = 0;
    band->hold(c.data());
    band->solve(r.data(), p.data());
    band->multiply(p.data(), r.data());
  }
  CHECK(allocations() == before);
}

}  // namespace held_band_tests
