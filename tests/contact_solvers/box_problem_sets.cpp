#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <vector>

#include "tests/allocations.hpp"
#include "tests/contact_solvers/box_problems.hpp"
#include "tests/eigen.hpp"

namespace box_problem_tests {

TEST_CASE("a cantilever pressed onto a flat stop", "[box]") {
  // reference: tip only for 8 < q < 72 with R = 3q/8 − 3; beyond, contact on [b, 1], b = (72/q)^¼, with the force q b/3
  // at b and q on [b, 1].
  for (const int m : {10, 50}) {
    const Solution open = solve(loaded_cantilever(m, 7.9));
    CHECK(open.p == VectorXd::Zero(m));
    const Solution tip = solve(loaded_cantilever(m, 40));
    // One active point: exact to the round-off of y° and the closed form.
    CHECK(tip.p[m - 1] == Approx(-(3 * 40 / 8.0 - 3)).epsilon(1e-13));
    CHECK((tip.p.array() != 0).count() == 1);
    const double q = 72 * 16;  // b = 1/2
    const Problem problem = loaded_cantilever(m, q);
    const Solution flat = solve(problem);
    check_complementarity(problem, flat);
    // The force at b spreads over a mesh length 1/m, the total follows with that error.
    CHECK(-flat.p.sum() == Approx(q / 6 + q / 2).epsilon(1.0 / m));
    for (int i = 0; i < m; ++i)
      if ((i + 1.0) / m < 0.5 - 1.0 / m) CHECK(flat.p[i] == 0);
  }
}

TEST_CASE("nearly singular: hundreds of nodes of a cantilever between two stops", "[box]") {
  // Condition 1e9 and more: efforts lose nine digits, complementarity none.
  Random random(11);
  for (int repeat = 0; repeat < 12; ++repeat) {
    const int m = repeat < 8 ? 50 : 200;
    Problem problem = loaded_cantilever(m, 0);
    problem.lower.setConstant(-0.1);
    problem.upper.setConstant(0.1);
    for (int k = 1; k <= 6; ++k) {
      const double amplitude = random(-1, 1);
      for (int i = 0; i < m; ++i) problem.free[i] += amplitude * std::sin((k - 0.5) * M_PI * (i + 1.0) / m);
    }
    if (repeat % 4 == 3)
      for (int i = 0; i < m; ++i) problem.free[i] += random(-0.01, 0.01);
    INFO("m " << m << " repeat " << repeat);
    const Solution s = solve(problem);
    check_complementarity(problem, s);
    // Each point enters or leaves a few times at most; pivoting by least index needs over 10⁵ sets here.
    CHECK(s.outcome.iterations <= 32 + 5 * m);
  }
}

TEST_CASE("the plain active set can cycle, descent does not", "[box]") {
  // Found by search over small integer matrices: symmetric positive definite, not an M-matrix, stop at zero below.
  struct Case {
    MatrixXd W;
    VectorXd free;
  };
  const Case cases[] = {
      {(MatrixXd(3, 3) << 27, 24, -21, 24, 22, -18, -21, -18, 19).finished(), Eigen::Vector3d(-3, -1, 3)},
      {(MatrixXd(3, 3) << 9, -10, 15, -10, 13, -15, 15, -15, 27).finished(), Eigen::Vector3d(2, -3, 2)},
      {(MatrixXd(4, 4) << 13, -11, 5, -10, -11, 10, -2, 8, 5, -2, 11, -7, -10, 8, -7, 10).finished(),
       Eigen::Vector4d(-2, 2, 1, -1)}};
  for (const auto& c : cases) {
    const long m = c.free.size();
    const Problem problem{c.W, 1, 0, c.free, VectorXd::Zero(m), VectorXd::Constant(m, infinity)};
    REQUIRE(eigen::values(c.W).minCoeff() > 0);
    BoxSolver plain;
    plain.prepare(static_cast<int>(m));
    plain.limit_descent(0);
    Columns columns(c.W);
    VectorXd p = VectorXd::Zero(m);
    const LaneOutcome stuck = plain.solve(columns, 1, 0, problem.free.data(), problem.lower.data(),
                                          problem.upper.data(), p.data(), static_cast<int>(m));
    CHECK_FALSE(stuck.converged);
    CHECK(stuck.iterations < 10);
    // The best iterate comes with its own residual.
    CHECK(stuck.residual == Approx(residual(problem, p)));

    const Solution s = solve(problem);
    check_complementarity(problem, s);
    // Condition below 1000 and integers below 30.
    CHECK((s.p - enumerate(problem)).norm() <= 1e-12);
  }
}

TEST_CASE("hard random operators never defeat descent", "[box]") {
  // Far from M-matrices: G Gᵀ with G of small integers, singular now and then.
  Random random(12);
  int solved = 0;
  for (int repeat = 0; repeat < 3000; ++repeat) {
    const int m = 3 + repeat % 10;
    const MatrixXd G = MatrixXd::NullaryExpr(m, m, [&] { return std::round(random(-3.5, 3.5)); });
    Problem problem{G * G.transpose(), 1, 0, {}, VectorXd::Zero(m), VectorXd::Constant(m, infinity)};
    if (problem.W.diagonal().minCoeff() == 0) continue;
    // y° in the image of W plus bounds: a solution always exists, also when W is singular.
    const VectorXd p = VectorXd::NullaryExpr(m, [&] { return std::max(0.0, std::round(random(-3, 3))); });
    problem.free = -problem.W * p;
    for (int i = 0; i < m; ++i)
      if (p[i] == 0) problem.free[i] += std::round(random(0, 3));
    if (repeat % 2 == 0) problem.upper = VectorXd::NullaryExpr(m, [&](Eigen::Index i) { return p[i] > 0 ? 1 : 9.0; });
    const Solution s = solve(problem);
    INFO("repeat " << repeat << " m " << m);
    check_complementarity(problem, s);
    ++solved;
  }
  // A point that nothing moves is rare among small integers.
  CHECK(solved > 2900);
}

TEST_CASE("two contact points at one place", "[box]") {
  Random random(13);
  for (int repeat = 0; repeat < 60; ++repeat) {
    const int base = 2 + repeat % 4, m = base + 2;
    Problem single = random.problem(base, 2);
    Problem twice;
    // Points 0 and base − 1 appear again at the end, their stops the same, or open a little further.
    std::vector<int> origin(static_cast<std::size_t>(m));
    for (int i = 0; i < base; ++i) origin[static_cast<std::size_t>(i)] = i;
    origin[static_cast<std::size_t>(base)] = 0;
    origin[static_cast<std::size_t>(base) + 1] = base - 1;
    twice.W = single.W(origin, origin);
    twice.free = single.free(origin);
    twice.lower = single.lower(origin);
    twice.upper = single.upper(origin);
    if (repeat % 3 > 0) {
      // The first of the pair is the one that lies behind: the choice by lowest index is wrong here.
      const double further = repeat % 3 == 1 ? 0.05 : 1e-9;
      twice.lower[0] -= further;
      twice.upper[base - 1] += further;
    }
    INFO("repeat " << repeat);
    const Solution s = solve(twice), expected = solve(single);
    check_complementarity(twice, s);
    VectorXd shared = s.p.head(base);
    shared[0] += s.p[base];
    shared[base - 1] += s.p[base + 1];
    // The sum of the pair is the effort of the single point, to a residual of 1e-12 times the condition 100.
    CHECK((shared - expected.p).norm() <= 1e-10 * (1 + expected.p.norm()));
  }
}

TEST_CASE("a rigid bar on more supports than it needs", "[box]") {
  // Rank 2, m supports: the efforts are not unique, their resultants are.
  for (int m = 3; m <= 12; ++m) {
    MatrixXd H(m, 2);
    for (int i = 0; i < m; ++i) H.row(i) << 1, 2.0 * i / (m - 1) - 1;
    for (const double tilt : {0.0, 0.3, -0.9}) {
      const Eigen::Vector2d fall(-1, tilt);
      Problem problem{H * H.transpose(), 1, 0, H * fall, VectorXd::Zero(m), VectorXd::Constant(m, infinity)};
      const Solution s = solve(problem);
      INFO("m " << m << " tilt " << tilt);
      check_complementarity(problem, s);
      CHECK(s.p.minCoeff() >= 0);
      // All supports touched: the bar is at rest on them, H(fall + Hᵀp) = 0 determines Hᵀp = −fall.
      CHECK((H.transpose() * s.p + fall).norm() <= 1e-11);
    }
  }
}

TEST_CASE("a point that nothing can move, and stops that contradict each other", "[box]") {
  Problem problem{MatrixXd::Zero(3, 3),    1, 0, Eigen::Vector3d(-2, -2, 0), Eigen::Vector3d(-1, -1, -1),
                  Eigen::Vector3d(1, 1, 1)};
  problem.W(1, 1) = 2;
  const Solution stuck = solve(problem);
  CHECK_FALSE(stuck.outcome.converged);
  CHECK(stuck.outcome.residual == 1);
  CHECK(stuck.p == Eigen::Vector3d(0, 0.5, 0));

  problem.free[0] = 0;
  CHECK(solve(problem).outcome.converged);

  // One place, first to stay above 1, then below 0.
  const Problem clash{MatrixXd::Ones(2, 2),        1, 0, Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(1, -infinity),
                      Eigen::Vector2d(infinity, 0)};
  const Solution none = solve(clash);
  CHECK_FALSE(none.outcome.converged);
  // Nothing does better than halfway.
  CHECK(none.outcome.residual >= 0.5);
  CHECK(std::isfinite(none.p.sum()));
}

TEST_CASE("data that are not finite are said, not passed on", "[box]") {
  for (const int m : {1, 5}) {
    const Problem good{MatrixXd::Identity(m, m), 1, 0, VectorXd::Constant(m, -2), VectorXd::Constant(m, -1),
                       VectorXd::Constant(m, 1)};
    for (const double bad : {std::nan(""), infinity, -infinity}) {
      Problem problem = good;
      problem.free[0] = bad;
      const Solution s = solve(problem);
      CHECK_FALSE(s.outcome.converged);
      CHECK(s.p == VectorXd::Zero(m));
    }
    Problem problem = good;
    problem.W(m - 1, 0) = std::nan("");
    const Solution s = solve(problem);
    CHECK_FALSE(s.outcome.converged);
    CHECK(std::isfinite(s.p.sum()));
  }
}

TEST_CASE("the start changes the efforts by round-off only", "[box]") {
  Random random(14);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Problem problem = random.problem(30, 2);
    const Solution cold = solve(problem);
    const Solution warm = solve(problem, cold.p);
    CHECK(warm.outcome.iterations <= cold.outcome.iterations);
    CHECK(warm.outcome.iterations == 1);
    CHECK(warm.p == cold.p);
    const Solution astray = solve(problem, VectorXd::NullaryExpr(30, [&] { return random(-1, 1); }));
    check_complementarity(problem, astray);
    // Condition 100.
    CHECK((astray.p - cold.p).norm() <= 1e5 * epsilon * (1 + cold.p.norm()));
  }
}

TEST_CASE("a lane among others gives what it gives alone, bit for bit", "[box]") {
  Random random(15);
  constexpr int m = 25, lanes = 7;
  const MatrixXd W = random.spd(m, 3);
  using Block = Eigen::Matrix<double, m, lanes, Eigen::RowMajor>;
  Block free, lower, upper, p = Block::Zero();
  std::vector<Problem> alone;
  for (int lane = 0; lane < lanes; ++lane) {
    Problem problem = random.problem(m, 1);
    problem.W = W;
    free.col(lane) = problem.free;
    lower.col(lane) = problem.lower;
    upper.col(lane) = problem.upper;
    alone.push_back(problem);
  }
  BoxSolver solver;
  solver.prepare(m + 5);
  Columns columns(W);
  for (int lane = lanes - 1; lane >= 0; --lane) {
    solver.solve(columns, 1, 0, free.data() + lane, lower.data() + lane, upper.data() + lane, p.data() + lane, m,
                 lanes);
    CHECK(VectorXd(p.col(lane)) == solve(alone[static_cast<std::size_t>(lane)]).p);
  }
}

TEST_CASE("solve allocates nothing, not even in descent", "[box]") {
  const long before_prepare = allocations();
  BoxSolver solver;
  solver.prepare(50);
  REQUIRE(allocations() > before_prepare);
  Random random(16);
  for (int repeat = 0; repeat < 30; ++repeat) {
    Problem problem = random.problem(50, repeat % 10);
    if (repeat % 5 == 0) problem.W.col(3) = problem.W.col(4), problem.W.row(3) = problem.W.row(4);
    Columns columns(problem.W);
    VectorXd p = VectorXd::Zero(50);
    const long before = allocations();
    solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 50);
    CHECK(allocations() == before);
  }
}

}  // namespace box_problem_tests
