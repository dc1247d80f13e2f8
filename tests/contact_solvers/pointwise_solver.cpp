// The force law recomputed at each answer, on random operators.
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <vector>

#include "tests/allocations.hpp"
#include "tests/eigen.hpp"

using namespace ricochet;

namespace pointwise_solver_tests {
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Columns final : DelassusColumns {
  explicit Columns(MatrixXd matrix) : W(std::move(matrix)) {}
  const double* column(int j) override { return W.data() + j * W.rows(); }
  MatrixXd W;
};

/// p = k δⁿ (1 + χ δ̇)₊, stiffness growing from lane to lane.
struct Power final : PointwiseLaw {
  double k = 1, n = 1, chi = 0;
  PointForce force(const ContactState& s) const override {
    if (!(s.depth > 0)) return {};
    const double factor = std::max(0.0, 1 + chi * s.rate), p = k * std::pow(s.depth, n);
    return {p * factor, n * p / s.depth * factor, factor > 0 ? chi * p : 0.0, 0, 0};
  }
};

/// A dashpot that is there or not: p = (k δ + c δ̇)₊ for δ > 0 jumps at entry.
struct Dashpot final : PointwiseLaw {
  double k = 1, c = 1;
  PointForce force(const ContactState& s) const override {
    const double p = k * s.depth + c * s.rate;
    if (!(s.depth > 0) || !(p > 0)) return {};
    return {p, k, c, 0, c * s.rate * s.rate};
  }
};

/// U = −k δ² ln(1 − δ/D): no depth reaches D.
struct Barrier final : PointwiseLaw {
  double k = 1, D = 0.1;
  PointForce force(const ContactState& s) const override {
    if (!(s.depth > 0)) return {};
    if (s.depth >= D) return {infinity, infinity, 0, 0, 0};
    const double r = 1 - s.depth / D, l = std::log(r);
    return {k * (s.depth * s.depth / (D * r) - 2 * s.depth * l),
            k * (s.depth * s.depth / (D * D * r * r) + 4 * s.depth / (D * r) - 2 * l), 0, 0, 0};
  }
};

struct Problem {
  MatrixXd W;
  double reach = 1, rate_reach = 0;
  VectorXd free, rate, lower, upper;
  int points() const { return static_cast<int>(free.size()); }
};

struct Solution {
  VectorXd p;
  LaneOutcome outcome;
  std::vector<ContactSlopes> slopes;
};

Solution solve(const PointwiseLaw& law, const Problem& problem, VectorXd start = {}, int newton = 60) {
  const int m = problem.points();
  PointwiseSolver solver;
  solver.prepare(m, 1);
  solver.limit(newton, 4000);
  Columns columns(problem.W);
  Solution s;
  s.p = start.size() > 0 ? start : VectorXd(VectorXd::Zero(m));
  ReducedProblem reduced;
  reduced.points = m;
  reduced.lanes = 1;
  reduced.delassus = &columns;
  reduced.reach = problem.reach;
  reduced.rate_reach = problem.rate_reach;
  reduced.free = problem.free.data();
  reduced.rate_free = problem.rate.data();
  reduced.lower = problem.lower.data();
  reduced.upper = problem.upper.data();
  reduced.effort = s.p.data();
  s.outcome = solver.solve(law, reduced, 0);
  for (int i = 0; i < m; ++i) s.slopes.push_back(solver.slopes(i, 0));
  return s;
}

// p − F(y(p), u(p)), and the size of what it is made of.
struct Error {
  double wrong = 0, size = 0;
};
Error error(const PointwiseLaw& law, const Problem& problem, const VectorXd& p) {
  const VectorXd moved = problem.W * p;
  const VectorXd y = problem.free + problem.reach * moved, u = problem.rate + problem.rate_reach * moved;
  const VectorXd terms = problem.W.cwiseAbs() * p.cwiseAbs();
  Error worst;
  for (int i = 0; i < problem.points(); ++i) {
    const PointForce low = law.force({problem.lower[i] - y[i], -u[i], 0, i, 0}),
                     high = law.force({y[i] - problem.upper[i], u[i], 0, i, 0});
    const double wrong = std::abs(p[i] - (low.value - high.value));
    if (!std::isfinite(wrong)) return {infinity, infinity};
    double bound = 0;
    for (const double b : {problem.lower[i], problem.upper[i]})
      if (std::isfinite(b)) bound = std::max(bound, std::abs(b));
    const double size =
        std::abs(p[i]) +
        (low.stiffness + high.stiffness) * (std::abs(problem.free[i]) + bound + problem.reach * terms[i]) +
        (low.viscosity + high.viscosity) * (std::abs(problem.rate[i]) + problem.rate_reach * terms[i]);
    if (wrong > 64 * epsilon * size) worst = {std::max(worst.wrong, wrong), std::max(worst.size, size)};
  }
  return worst;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * uniform_(engine_); }
  MatrixXd spd(int m, double decades) {
    const MatrixXd Q = eigen::orthogonal(MatrixXd::NullaryExpr(m, m, [&] { return (*this)(-1, 1); }));
    VectorXd d(m);
    for (int i = 0; i < m; ++i) d[i] = std::pow(10, -decades * i / std::max(1, m - 1));
    const MatrixXd W = Q * d.asDiagonal() * Q.transpose();
    return (W + W.transpose()) / 2;
  }
  Problem problem(int m, double decades) {
    Problem p;
    p.W = spd(m, decades);
    p.reach = (*this)(0.1, 2);
    p.rate_reach = (*this)(0, 2);
    p.free = VectorXd::NullaryExpr(m, [&] { return (*this)(-1, 1); });
    p.rate = VectorXd::NullaryExpr(m, [&] { return (*this)(-1, 1); });
    p.lower = VectorXd::NullaryExpr(m, [&] { return (*this)(0, 1) < 0.2 ? -infinity : (*this)(-0.6, 0); });
    p.upper = VectorXd::NullaryExpr(m, [&] { return (*this)(0, 1) < 0.2 ? infinity : (*this)(0, 0.6); });
    return p;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

}  // namespace

TEST_CASE("the efforts are those of the force law", "[pointwise]") {
  Random random(1);
  int most = 0;
  for (int m = 1; m <= 20; ++m)
    for (int repeat = 0; repeat < 40; ++repeat) {
      Power law;
      law.k = std::pow(10, random(-2, 8));
      law.n = 1 + (repeat % 3) * 0.75;
      law.chi = repeat % 2 == 0 ? 0 : random(0, 3);
      const Problem problem = random.problem(m, repeat % 7);
      INFO("m " << m << " repeat " << repeat << " k " << law.k << " n " << law.n << " chi " << law.chi);
      const Solution s = solve(law, problem);
      CHECK(s.outcome.converged);
      CHECK(error(law, problem, s.p).wrong == 0);
      // In metres: the round-off of a measure of order one, with at most 20 terms that may cancel.
      CHECK(s.outcome.residual <= 1e-11 * (1 + (problem.W.cwiseAbs() * s.p.cwiseAbs()).maxCoeff()));
      most = std::max(most, s.outcome.iterations);
      // From anywhere, the same answer.
      const Solution again = solve(law, problem, VectorXd::NullaryExpr(m, [&] { return random(-10, 10); }));
      CHECK(error(law, problem, again.p).wrong == 0);
      // From there, nothing is left to do.
      if (m > 1) CHECK(solve(law, problem, s.p).outcome.iterations <= 1);
    }
  CHECK(most < 40);
}

TEST_CASE("Gauss-Seidel finds what Newton finds", "[pointwise]") {
  Random random(2);
  for (int repeat = 0; repeat < 30; ++repeat) {
    Power law;
    law.k = random(0.1, 30);
    law.n = 1.5;
    law.chi = random(0, 2);
    const Problem problem = random.problem(8, 1);
    const Solution newton = solve(law, problem), sweeps = solve(law, problem, {}, 0);
    CHECK(sweeps.outcome.converged);
    CHECK(sweeps.outcome.iterations >= newton.outcome.iterations);
    CHECK((sweeps.p - newton.p).norm() <= 1e-11 * (1 + newton.p.norm()));
  }
}

TEST_CASE("exponent 1 is the box problem with a compliance", "[pointwise]") {
  Random random(3);
  for (int repeat = 0; repeat < 40; ++repeat) {
    const int m = 1 + repeat % 12;
    Power law;
    law.k = std::pow(10, random(-1, 4));
    Problem problem = random.problem(m, 2);
    BoxSolver box;
    box.prepare(m);
    Columns columns(problem.W);
    VectorXd p = VectorXd::Zero(m);
    box.solve(columns, problem.reach, 1 / law.k, problem.free.data(), problem.lower.data(), problem.upper.data(),
              p.data(), m);
    // Condition of W at most 100.
    CHECK((solve(law, problem).p - p).norm() <= 1e-11 * (1 + p.norm()));
  }
}

TEST_CASE("a jump is bridged, and a barrier is not passed", "[pointwise]") {
  Random random(4);
  for (int repeat = 0; repeat < 30; ++repeat) {
    Problem problem = random.problem(1 + repeat % 5, 1);
    problem.rate_reach = 1;
    Dashpot dashpot;
    dashpot.k = random(1, 100);
    dashpot.c = random(1, 100);
    const Solution s = solve(dashpot, problem);
    INFO("repeat " << repeat);
    CHECK(s.outcome.converged);
    CHECK(s.outcome.residual <= 1e-12);
    const VectorXd moved = problem.W * s.p, y = problem.free + problem.reach * moved, u = problem.rate + moved;
    // The power that the efforts take, less what the springs keep of it: not what the whole jump would.
    double power = 0;
    for (int i = 0; i < problem.points(); ++i) {
      const double depth = std::max({problem.lower[i] - y[i], y[i] - problem.upper[i], 0.0});
      if (s.p[i] != 0) power -= (s.p[i] - std::copysign(dashpot.k * depth, s.p[i])) * u[i];
    }
    CHECK(s.outcome.dissipation == Approx(power).epsilon(1e-9).margin(1e-9));
    for (int i = 0; i < problem.points(); ++i) {
      const bool low = s.p[i] > 0;
      // Without effort: not there, or leaving faster than the spring follows.
      const auto full = [&](double depth, double rate) { return dashpot.force({depth, rate, 0, i, 0}).value; };
      if (s.p[i] == 0) {
        CHECK(full(problem.lower[i] - y[i] - 1e-12, -u[i]) == 0);
        CHECK(full(y[i] - problem.upper[i] - 1e-12, u[i]) == 0);
        continue;
      }
      const double depth = low ? problem.lower[i] - y[i] : y[i] - problem.upper[i], rate = low ? -u[i] : u[i];
      CHECK(depth >= -1e-13);
      if (depth > 1e-12)
        CHECK(std::abs(s.p[i]) == Approx(full(depth, rate)).epsilon(1e-9).margin(1e-9));
      else
        CHECK(std::abs(s.p[i]) <= dashpot.k * 1e-12 + dashpot.c * std::max(0.0, rate) + 1e-9);
    }

    Barrier barrier;
    barrier.k = random(1e-3, 10);
    const Solution held = solve(barrier, problem);
    CHECK(held.outcome.converged);
    CHECK(error(barrier, problem, held.p).wrong == 0);
    const VectorXd at = problem.free + problem.reach * (problem.W * held.p);
    CHECK((problem.lower - at).maxCoeff() < barrier.D);
    CHECK((at - problem.upper).maxCoeff() < barrier.D);
  }
}

TEST_CASE("slopes are the derivative of the effort with respect to what is given", "[pointwise]") {
  Random random(5);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const int m = 1 + repeat % 6;
    Power law;
    law.k = random(1, 100);
    law.n = 1.5;
    law.chi = random(0, 1);
    Problem problem = random.problem(m, 1);
    const Solution s = solve(law, problem);
    const VectorXd way = VectorXd::NullaryExpr(m, [&] { return random(-1, 1); });
    const VectorXd rate_way = VectorXd::NullaryExpr(m, [&] { return random(-1, 1); });
    // (I + DW) δp = −D_δ δg° − D_u δu°
    MatrixXd A = MatrixXd::Identity(m, m);
    VectorXd right(m);
    for (int i = 0; i < m; ++i) {
      const ContactSlopes& d = s.slopes[static_cast<std::size_t>(i)];
      A.row(i) += (d.stiffness * problem.reach + d.viscosity * problem.rate_reach) * problem.W.row(i);
      right[i] = -d.stiffness * way[i] - d.viscosity * rate_way[i];
    }
    const VectorXd expected = eigen::lu_solve(A, right);
    const double step = 1e-6;
    Problem ahead = problem, behind = problem;
    ahead.free += step * way;
    ahead.rate += step * rate_way;
    behind.free -= step * way;
    behind.rate -= step * rate_way;
    const VectorXd difference = (solve(law, ahead).p - solve(law, behind).p) / (2 * step);
    // Round-off over the step, 1e-9 of the force; curvature of a depth of 1e-3 m, step²/depth².
    CHECK((difference - expected).norm() <= 1e-5 * (1 + expected.norm()));
  }
}

TEST_CASE("what the effort does not move is the law itself", "[pointwise]") {
  Problem problem = Random(6).problem(5, 1);
  problem.reach = problem.rate_reach = 0;
  Power law;
  law.k = 7;
  law.n = 1.5;
  law.chi = 0.4;
  const Solution s = solve(law, problem);
  for (int i = 0; i < 5; ++i) {
    const double low = law.force({problem.lower[i] - problem.free[i], -problem.rate[i], 0, i, 0}).value;
    const double high = law.force({problem.free[i] - problem.upper[i], problem.rate[i], 0, i, 0}).value;
    CHECK(s.p[i] == low - high);
  }
  CHECK(s.outcome.iterations == 1);
  CHECK(s.outcome.residual == 0);
}

TEST_CASE("a nonlinear lane among others gives what it gives alone, and nothing is allocated", "[pointwise]") {
  Random random(7);
  constexpr int m = 12, lanes = 5;
  const MatrixXd W = random.spd(m, 3);
  using Block = Eigen::Matrix<double, m, lanes, Eigen::RowMajor>;
  Block free, rate, lower, upper, p = Block::Zero();
  Power law;
  law.k = 1e3;
  law.n = 1.5;
  law.chi = 0.3;
  std::vector<Problem> alone;
  for (int lane = 0; lane < lanes; ++lane) {
    Problem problem = random.problem(m, 1);
    problem.W = W;
    problem.reach = 0.7;
    problem.rate_reach = 1.3;
    free.col(lane) = problem.free;
    rate.col(lane) = problem.rate;
    lower.col(lane) = problem.lower;
    upper.col(lane) = problem.upper;
    alone.push_back(problem);
  }
  PointwiseSolver solver;
  solver.prepare(m + 3, lanes);
  Columns columns(W);
  ReducedProblem reduced;
  reduced.points = m;
  reduced.lanes = lanes;
  reduced.delassus = &columns;
  reduced.reach = 0.7;
  reduced.rate_reach = 1.3;
  reduced.free = free.data();
  reduced.rate_free = rate.data();
  reduced.lower = lower.data();
  reduced.upper = upper.data();
  reduced.effort = p.data();
  for (int lane = lanes - 1; lane >= 0; --lane) {
    const long before = allocations();
    const LaneOutcome outcome = solver.solve(law, reduced, lane);
    CHECK(allocations() == before);
    CHECK(outcome.converged);
  }
  solver.limit(0, 4000);
  Block again = Block::Zero();
  reduced.effort = again.data();
  const long before = allocations();
  solver.solve(law, reduced, 2);
  CHECK(allocations() == before);
  for (int lane = 0; lane < lanes; ++lane) {
    const Solution one = solve(law, alone[static_cast<std::size_t>(lane)]);
    CHECK(VectorXd(p.col(lane)) == one.p);
    solver.limit(60, 4000);
  }
}

TEST_CASE("data that are not finite end a nonlinear solve", "[pointwise]") {
  for (const int m : {1, 4}) {
    Problem problem = Random(8).problem(m, 1);
    problem.free[m - 1] = std::nan("");
    const Solution s = solve(Power{}, problem, VectorXd::Ones(m));
    CHECK_FALSE(s.outcome.converged);
    CHECK(s.p == VectorXd::Zero(m));
  }
}

TEST_CASE("a law without a finite force has no residual of a finite size, whatever slope it names", "[pointwise]") {
  struct Wall final : PointwiseLaw {
    double slope = 0;
    PointForce force(const ContactState& s) const override {
      return s.depth > 0 ? PointForce{infinity, slope, 0, 0, 0} : PointForce{};
    }
  } wall;
  for (const int points : {1, 2})
    for (const double slope : {0.0, 1.0, infinity, std::nan("")})
      for (const double reach : {0.0, 1.0})
        for (const double rate_reach : {0.0, 1.0}) {
          CAPTURE(points, slope, reach, rate_reach);
          wall.slope = slope;
          Problem problem;
          problem.W = 200 * MatrixXd::Identity(points, points);
          problem.reach = reach;
          problem.rate_reach = rate_reach;
          problem.free = VectorXd::Constant(points, 2);
          problem.upper = VectorXd::Ones(points);
          problem.lower = problem.rate = VectorXd::Zero(points);
          const Solution s = solve(wall, problem);
          if (!s.outcome.converged) CHECK(s.outcome.residual == infinity);
          if (reach == 0) CHECK_FALSE(s.outcome.converged);
        }
}

}  // namespace pointwise_solver_tests
