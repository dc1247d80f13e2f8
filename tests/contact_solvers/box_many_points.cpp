// Box problems of hundreds of points, whose operator is that of a band: held there, against the columns alone.
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/held_band.hpp>

#include "tests/allocations.hpp"
#include "tests/eigen.hpp"

namespace many_points_tests {

using namespace ricochet;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A clamped row of masses m with bending stiffness k between them: S = m I + k DᵀD, D second differences.
struct Row {
  explicit Row(int masses, double k, int twice = 0) : n(masses) {
    MatrixXd D = MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      D(i, i) = 1;
      if (i > 0) D(i, i - 1) = -2;
      if (i > 1) D(i, i - 2) = 1;
    }
    const MatrixXd whole = MatrixXd::Identity(n, n) + k * D.transpose() * D;
    S.A = whole.sparseView();
    for (int i = 0; i < n + twice; ++i) {
      // Points beyond n stand where others do.
      index.push_back(i < n ? i : (i - n) * 7);
      value.push_back(1);
      start.push_back(i + 1);
    }
    const MatrixXd inverse = eigen::ldlt_solve_all(whole, MatrixXd::Identity(n, n));
    W = inverse(index, index);
    held = HeldBand::make(S, {points(), start.data(), index.data(), value.data()});
  }
  int points() const { return static_cast<int>(index.size()); }
  int n;
  QuasiDefinite S;
  std::vector<int> start{0}, index;
  std::vector<double> value;
  MatrixXd W;
  std::unique_ptr<HeldBand> held;
};

struct Columns final : BandDelassus {
  Columns(const Row& of, bool with_band) : row(of), band(with_band ? of.held.get() : nullptr) {}
  const double* column(int j) override {
    ++asked;
    return row.W.data() + j * row.W.rows();
  }
  HeldBand* held() override { return band; }
  const Row& row;
  HeldBand* band;
  int asked = 0;
};

struct Problem {
  const Row& row;
  VectorXd free, lower, upper;
  double reach = 1, compliance = 0;
  int points() const { return row.points(); }
  VectorXd measure(const VectorXd& p) const { return free + reach * (row.W * p) + compliance * p; }
};

struct Solution {
  VectorXd p;
  LaneOutcome outcome;
  int asked = 0;
};

Solution solve(const Problem& problem, bool with_band, const VectorXd& start = {}) {
  BoxSolver solver;
  solver.prepare(problem.points());
  Columns columns(problem.row, with_band);
  Solution s;
  s.p = start.size() > 0 ? start : VectorXd(VectorXd::Zero(problem.points()));
  s.outcome = solver.solve(columns, problem.reach, problem.compliance, problem.free.data(), problem.lower.data(),
                           problem.upper.data(), s.p.data(), problem.points());
  s.asked = columns.asked;
  return s;
}

int pushing(const VectorXd& p) {
  return static_cast<int>((p.array() != 0).count());
}

// (2) of box_problem.hpp, from the dense W.
double residual(const Problem& problem, const VectorXd& p) {
  const VectorXd y = problem.measure(p);
  double worst = 0;
  for (int i = 0; i < problem.points(); ++i) {
    const double a = problem.reach * problem.row.W(i, i) + problem.compliance;
    worst = std::max({worst, problem.lower[i] - y[i], y[i] - problem.upper[i],
                      std::min(a * std::max(p[i], 0.0), y[i] - problem.lower[i]),
                      std::min(a * std::max(-p[i], 0.0), problem.upper[i] - y[i])});
  }
  return worst;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * uniform_(engine_); }
  /// A row that lies on its lower stop along most of its length, rises here and there, and meets the upper one.
  Problem lying(const Row& row, double roughness) {
    Problem problem{row, VectorXd(row.points()), VectorXd::Constant(row.points(), -1),
                    VectorXd::Constant(row.points(), 1.2)};
    const double turns = (*this)(2, 9), phase = (*this)(0, 6);
    for (int i = 0; i < row.points(); ++i) {
      const double x = double(row.index[static_cast<std::size_t>(i)]) / row.n;
      problem.free[i] = -1.6 + 3 * std::pow(std::sin(turns * x + phase), 8) + roughness * (*this)(-1, 1);
      if ((*this)(0, 1) < 0.05) problem.lower[i] = -infinity;
    }
    return problem;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

// What both ways may differ by, as W is not formed by the same sums in both. Factors: round-off of one solve, the
// condition of W (1 + 16k), the number of points.
double close(const Row& row, double k) {
  return 100 * (1 + 16 * k) * row.points() * epsilon;
}

}  // namespace

TEST_CASE("hundreds of points held in the band solve the same problem as by columns", "[box][many]") {
  Random random(1);
  for (const double k : {0.05, 3.0}) {
    const Row row(500, k);
    int held = 0;
    for (int repeat = 0; repeat < 12; ++repeat) {
      Problem problem = random.lying(row, repeat % 3 == 0 ? 0.3 : 1e-3);
      if (repeat % 4 == 1) problem.compliance = random(0.01, 1);
      if (repeat % 4 == 2) problem.reach = random(0.1, 5);
      INFO("k " << k << " repeat " << repeat);
      const Solution by_columns = solve(problem, false), in_band = solve(problem, true);
      CHECK(in_band.outcome.converged);
      CHECK(by_columns.outcome.converged);
      held += pushing(in_band.p) > BoxSolver::many;
      CHECK((in_band.p - by_columns.p).norm() <= close(row, k) * by_columns.p.norm());
      // The same points push: no set was taken for another.
      CHECK(((in_band.p.array() > 0) == (by_columns.p.array() > 0)).all());
      const double terms = problem.free.cwiseAbs().maxCoeff() + 1.2 + problem.reach * in_band.p.cwiseAbs().maxCoeff();
      CHECK(residual(problem, in_band.p) <= close(row, k) * terms);
    }
    CHECK(held > 4);
  }
}

TEST_CASE("many points ask for no column", "[box][many]") {
  const Row row(400, 0.5);
  Problem problem{row, VectorXd::Constant(400, -2), VectorXd::Constant(400, -1), VectorXd::Constant(400, 1)};
  const Solution s = solve(problem, true);
  CHECK(s.outcome.converged);
  CHECK(pushing(s.p) > 300);
  CHECK(s.asked == 0);
}

TEST_CASE("few points give bitwise equal results, with a band and without", "[box][many]") {
  Random random(2);
  const Row row(300, 1.0);
  int few = 0;
  for (int repeat = 0; repeat < 30; ++repeat) {
    Problem problem = random.lying(row, 1e-2);
    problem.free.array() += random(0.5, 0.62);
    const Solution by_columns = solve(problem, false), in_band = solve(problem, true);
    if (pushing(by_columns.p) > BoxSolver::many || pushing(by_columns.p) < 2) continue;
    ++few;
    CHECK(in_band.p == by_columns.p);
  }
  CHECK(few > 10);
}

TEST_CASE("from a set that is wrong everywhere the same solution is found, and soon", "[box][many]") {
  Random random(3);
  for (const double k : {0.5, 50.0, 5e3}) {
    const Row row(600, k);
    for (int repeat = 0; repeat < 4; ++repeat) {
      const Problem problem = random.lying(row, 1e-3);
      const Solution cold = solve(problem, true);
      const Solution warm = solve(problem, true, cold.p);
      INFO("k " << k << " repeat " << repeat);
      CHECK(warm.p == cold.p);
      CHECK(warm.outcome.iterations <= 1);
      const VectorXd none_that_push = cold.p.unaryExpr([](double p) { return p > 0 ? 0.0 : 1.0; });
      for (const VectorXd& start : {VectorXd(VectorXd::Ones(600)), VectorXd(-VectorXd::Ones(600)), none_that_push,
                                    VectorXd(VectorXd::NullaryExpr(600, [&] { return random(-1, 1); }))}) {
        const Solution astray = solve(problem, true, start);
        CHECK(astray.outcome.converged);
        CHECK((astray.p - cold.p).norm() <= close(row, k) * (1 + cold.p.norm()));
        // An interior point of some twenty iterations, and few sets before and behind it.
        CHECK(astray.outcome.iterations <= 120);
      }
    }
  }
}

TEST_CASE("points at one place among many share what the place needs", "[box][many]") {
  Random random(4);
  const Row single(350, 0.5), twice(350, 0.5, 50);
  for (int repeat = 0; repeat < 6; ++repeat) {
    Problem problem = random.lying(twice, 0.0);
    problem.lower.setConstant(-1);
    // The second of each pair has its stop further back, or at the same place.
    for (int i = 350; i < 400 && repeat % 2 == 1; ++i) problem.lower[i] -= 0.01 * (i % 3);
    const Problem alone{single, problem.free.head(350), problem.lower.head(350), problem.upper.head(350)};
    const Solution both = solve(problem, true), expected = solve(alone, true);
    INFO("repeat " << repeat);
    CHECK(both.outcome.converged);
    VectorXd shared = both.p.head(350);
    for (int i = 350; i < 400; ++i) shared[twice.index[static_cast<std::size_t>(i)]] += both.p[i];
    CHECK(pushing(expected.p) > BoxSolver::many);
    CHECK((shared - expected.p).norm() <= close(single, 0.5) * expected.p.norm());
  }
}

TEST_CASE("a lane of many points among others gives what it gives alone, bit for bit", "[box][many]") {
  Random random(5);
  const Row row(300, 1.0);
  constexpr int lanes = 4;
  using Block = Eigen::Matrix<double, Eigen::Dynamic, lanes, Eigen::RowMajor>;
  Block free(300, lanes), lower(300, lanes), upper(300, lanes), p = Block::Zero(300, lanes);
  std::vector<Problem> alone;
  for (int lane = 0; lane < lanes; ++lane) {
    alone.push_back(random.lying(row, 1e-2));
    free.col(lane) = alone.back().free;
    lower.col(lane) = alone.back().lower;
    upper.col(lane) = alone.back().upper;
  }
  // One solver and one band for all of them, several times over: what they held last is another lane's set.
  BoxSolver solver;
  solver.prepare(300);
  Columns columns(row, true);
  for (int repeat = 0; repeat < 2; ++repeat) {
    p.setZero();
    for (int lane = lanes - 1; lane >= 0; --lane) {
      solver.solve(columns, 1, 0, free.data() + lane, lower.data() + lane, upper.data() + lane, p.data() + lane, 300,
                   lanes);
      const Row own(300, 1.0);
      const Problem& problem = alone[static_cast<std::size_t>(lane)];
      CHECK(VectorXd(p.col(lane)) == solve({own, problem.free, problem.lower, problem.upper}, true).p);
    }
  }
}

TEST_CASE("many points allocate nothing once an interior point was needed", "[box][many]") {
  Random random(6);
  const Row row(400, 20.0);
  BoxSolver solver;
  solver.prepare(400);
  Columns columns(row, true);
  long before = 0;
  for (int repeat = 0; repeat < 6; ++repeat) {
    const Problem problem = random.lying(row, 1e-3);
    VectorXd p = repeat % 2 == 0 ? VectorXd(-VectorXd::Ones(400)) : VectorXd(VectorXd::Zero(400));
    if (repeat == 1) before = allocations();
    const long now = allocations();
    solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 400);
    if (repeat > 0) CHECK(allocations() == now);
  }
  CHECK(before > 0);
}

}  // namespace many_points_tests
