#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <vector>

#include "tests/allocations.hpp"
#include "tests/contact_solvers/pointwise_problems.hpp"
#include "tests/eigen.hpp"

namespace pointwise_solver_tests {

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
