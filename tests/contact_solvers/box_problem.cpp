#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <ricochet/contact_solvers/box_problem.hpp>

#include "tests/contact_solvers/box_problems.hpp"
#include "tests/eigen.hpp"

namespace box_problem_tests {

TEST_CASE("the effort is the one of enumeration", "[box]") {
  Random random(1);
  for (int m = 1; m <= 8; ++m)
    for (int repeat = 0; repeat < (m <= 6 ? 40 : 3); ++repeat) {
      Problem problem = random.problem(m, 2);
      if (repeat % 3 == 1) problem.compliance = random(1e-3, 10);
      if (repeat % 3 == 2) problem.reach = random(0.1, 5);
      INFO("m " << m << " repeat " << repeat);
      const Solution s = solve(problem);
      check_complementarity(problem, s);
      const VectorXd expected = enumerate(problem);
      // Condition 100 at most: two stable solves of one system differ by 100·m·ε, with a margin of ten.
      CHECK((s.p - expected).norm() <= 1e4 * m * epsilon * (1 + expected.norm()));
    }
}

TEST_CASE("an ill-conditioned operator still gives the measure of enumeration", "[box]") {
  Random random(2);
  for (int m = 2; m <= 6; ++m)
    for (int repeat = 0; repeat < 30; ++repeat) {
      const Problem problem = random.problem(m, 10);
      INFO("m " << m << " repeat " << repeat);
      const Solution s = solve(problem);
      check_complementarity(problem, s);
      const VectorXd expected = enumerate(problem);
      // Efforts grow like the condition 1e10 and cancel in A p: only y is well defined, to their size times ε. Moving
      // the data by δ moves y by up to √(condition)·δ where a point enters or leaves.
      CHECK((problem.measure(s.p) - problem.measure(expected)).cwiseAbs().maxCoeff() <=
            1e5 * 100 * epsilon * (1 + expected.norm()));
    }
}

TEST_CASE("m = 50 agrees with projected Gauss-Seidel", "[box]") {
  Random random(3);
  for (int repeat = 0; repeat < 6; ++repeat) {
    Problem problem = random.problem(50, 2);
    if (repeat % 2 == 1) problem.compliance = 0.1;
    const Solution s = solve(problem);
    check_complementarity(problem, s);
    const VectorXd expected = gauss_seidel(problem, 4000);
    // Gauss-Seidel contracts by about 1 − 1/condition per sweep: 4000 sweeps at condition 100 leave e^-40, below ε.
    CHECK((s.p - expected).norm() <= 1e-10 * expected.norm());
  }
}

TEST_CASE("an open lane has no effort and asks for no column", "[box]") {
  Problem problem = Random(4).problem(12, 1);
  problem.free.setZero();
  Columns columns(problem.W);
  BoxSolver solver;
  solver.prepare(12);
  VectorXd p = VectorXd::Ones(12);
  const LaneOutcome outcome =
      solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 12);
  CHECK(outcome.converged);
  CHECK(p == VectorXd::Zero(12));
  CHECK(columns.touched() == 0);
}

TEST_CASE("one candidate is the closed form and asks for one column", "[box]") {
  const MatrixXd W = Random(5).spd(50, 1);
  for (const double side : {1.0, -1.0}) {
    Problem problem{W, 0.5, 0.25, VectorXd::Zero(50), VectorXd::Constant(50, -10), VectorXd::Constant(50, 10)};
    problem.free[17] = side * 10.5;
    Columns columns(W);
    BoxSolver solver;
    solver.prepare(50);
    VectorXd p = VectorXd::Zero(50);
    const LaneOutcome outcome =
        solver.solve(columns, 0.5, 0.25, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 50);
    CHECK(outcome.converged);
    CHECK(outcome.iterations == 1);
    CHECK(columns.touched() == 1);
    CHECK(p[17] == -side * 0.5 / (0.5 * W(17, 17) + 0.25));
    CHECK((p.array() != 0).count() == 1);
  }
}

TEST_CASE("columns are asked for only at points of the sets tried", "[box]") {
  // Two groups that do not see each other: the second stays open and is never asked for.
  Random random(6);
  Problem problem{MatrixXd::Zero(40, 40),   1, 0, VectorXd::Zero(40), VectorXd::Constant(40, -1),
                  VectorXd::Constant(40, 1)};
  problem.W.topLeftCorner(20, 20) = random.spd(20, 2);
  problem.W.bottomRightCorner(20, 20) = random.spd(20, 2);
  problem.free.head(20).setConstant(-1.5);
  Columns columns(problem.W);
  BoxSolver solver;
  solver.prepare(40);
  VectorXd p = VectorXd::Zero(40);
  CHECK(solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 40)
            .converged);
  CHECK(columns.touched() <= 20);
}

TEST_CASE("one point alone", "[box]") {
  const MatrixXd W = MatrixXd::Constant(1, 1, 4);
  const auto one = [&](double free, double lower, double upper, double compliance, double reach = 0.5) {
    const Problem problem{
        W, reach, compliance, VectorXd::Constant(1, free), VectorXd::Constant(1, lower), VectorXd::Constant(1, upper)};
    return solve(problem, VectorXd::Constant(1, 3.0));
  };
  CHECK(one(-3, -1, 1, 0).p[0] == 1);
  CHECK(one(3, -1, 1, 2).p[0] == -0.5);
  CHECK(one(0, -1, 1, 0).p[0] == 0);
  CHECK(one(-3, -infinity, 1, 0).p[0] == 0);
  CHECK(one(-3, -1, 1, 2, 0).p[0] == 1);
  CHECK(one(5, 2, 2, 0).p[0] == -1.5);
  CHECK_FALSE(one(-3, -1, 1, 0, 0).outcome.converged);
  CHECK(one(-3, -1, 1, 0, 0).outcome.residual == 2);
}

TEST_CASE("a bound that is met without effort, exactly", "[box]") {
  // W = [2 1; 1 2]: the effort that brings point 0 to its stop leaves point 1 on its own stop, with p = 0.
  Problem problem{(MatrixXd(2, 2) << 2, 1, 1, 2).finished(), 1, 0, Eigen::Vector2d(-2, 0), Eigen::Vector2d(0, 1),
                  Eigen::Vector2d(infinity, infinity)};
  for (const auto& start : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Eigen::Vector2d(0, 1)}) {
    const Solution s = solve(problem, start);
    CHECK(s.outcome.converged);
    CHECK(s.p == Eigen::Vector2d(1, 0));
  }
}

TEST_CASE("degenerate contacts: every point ends on its stop, some by chance", "[box]") {
  Random random(7);
  for (int repeat = 0; repeat < 60; ++repeat) {
    const int m = 2 + repeat % 7;
    Problem problem = random.problem(m, repeat % 2 == 0 ? 1 : 6);
    // y° chosen so that y = lower everywhere, with p > 0 at every second point only.
    VectorXd p(m);
    for (int i = 0; i < m; ++i) {
      p[i] = i % 2 == 0 ? random(0.1, 1) : 0;
      problem.lower[i] = random(-1, 0);
      problem.upper[i] = random.chance(0.5) ? problem.lower[i] + 1 : infinity;
    }
    problem.free = problem.lower - problem.A() * p;
    INFO("m " << m << " repeat " << repeat);
    const Solution s = solve(problem, VectorXd::Ones(m));
    check_complementarity(problem, s);
    // A degenerate p is fixed by y alone, to round-off over the smallest eigenvalue, 10⁻¹ or 10⁻⁶.
    CHECK((s.p - p).norm() <= 1e3 * epsilon * (repeat % 2 == 0 ? 1e1 : 1e6) * (1 + p.norm()));
  }
}

TEST_CASE("lower = upper is an equality, of either sign", "[box]") {
  Random random(8);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Problem problem = random.problem(6, 3);
    problem.lower = problem.upper = VectorXd::NullaryExpr(6, [&] { return random(-1, 1); });
    const Solution s = solve(problem);
    check_complementarity(problem, s);
    const VectorXd expected = eigen::ldlt_solve(problem.A(), problem.lower - problem.free);
    // Condition 1000, two stable solves.
    CHECK((s.p - expected).norm() <= 1e5 * epsilon * expected.norm());
  }
}

TEST_CASE("an explicit evaluation is each point on its own", "[box]") {
  Problem problem = Random(9).problem(20, 2);
  problem.reach = 0;
  problem.compliance = 1e-5;
  Columns columns(problem.W);
  BoxSolver solver;
  solver.prepare(20);
  VectorXd p = VectorXd::Ones(20);
  CHECK(solver.solve(columns, 0, 1e-5, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 20)
            .converged);
  CHECK(columns.touched() == 0);
  for (int i = 0; i < 20; ++i) {
    const double f = problem.free[i];
    CHECK(p[i] == (f < problem.lower[i]   ? (problem.lower[i] - f) / 1e-5
                   : f > problem.upper[i] ? (problem.upper[i] - f) / 1e-5
                                          : 0.0));
  }
}

TEST_CASE("units do not matter: powers of two change nothing but the exponent", "[box]") {
  Random random(10);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Problem problem = random.problem(20, repeat);
    const Solution s = solve(problem);
    for (const double length : {0x1p-60, 0x1p40})
      for (const double reach : {0x1p-80, 0x1p80}) {
        Problem scaled = problem;
        scaled.reach *= reach;
        scaled.free *= length;
        scaled.lower *= length;
        scaled.upper *= length;
        const Solution t = solve(scaled);
        CHECK(t.outcome.iterations == s.outcome.iterations);
        CHECK(t.p * (reach / length) == s.p);
      }
  }
}

}  // namespace box_problem_tests
