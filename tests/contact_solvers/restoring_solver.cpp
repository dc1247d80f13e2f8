// The work recomputed at each answer, on random operators.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/contact_solvers/restoring_solver.hpp>
#include <vector>

#include "tests/allocations.hpp"

using namespace ricochet;

namespace restoring_solver_tests {
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Columns final : DelassusColumns {
  explicit Columns(MatrixXd matrix) : W(std::move(matrix)) {}
  const double* column(int j) override {
    asked.push_back(j);
    return W.data() + j * W.rows();
  }
  MatrixXd W;
  std::vector<int> asked;
};

struct Problem {
  MatrixXd W;
  VectorXd free, pushed, way;
  double reach = 0.5, uncertainty = 0;
};

struct Solution {
  VectorXd p;
  LaneOutcome outcome;
  std::vector<int> asked;
};

Solution solve(const Problem& problem, int newton = 60, int sweeps = 4000) {
  const int m = static_cast<int>(problem.free.size());
  RestoringSolver solver;
  solver.prepare(m);
  solver.limit(newton, sweeps);
  Columns columns(problem.W);
  Solution solution{VectorXd::Constant(m, 7), {}, {}};
  solution.outcome = solver.solve(columns,
                                  {.reach = problem.reach,
                                   .free = problem.free.data(),
                                   .pushed = problem.pushed.data(),
                                   .way = problem.way.data(),
                                   .uncertainty = problem.uncertainty},
                                  solution.p.data(), m);
  solution.asked = columns.asked;
  return solution;
}

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  std::mt19937 engine;
  std::normal_distribution<double> normal;
  VectorXd vector(int m) {
    VectorXd x(m);
    for (double& one : x) one = normal(engine);
    return x;
  }
  // Pushed to both sides, some points not at all, some without any work.
  Problem problem(int m, int rank) {
    MatrixXd R(m, rank);
    for (double& one : R.reshaped()) one = normal(engine);
    Problem made{R * R.transpose(), vector(m), vector(m), vector(m)};
    for (int i = 0; i < m; ++i) {
      if (i % 5 == 4) made.pushed[i] = 0;
      made.way[i] = i % 3 == 2 ? 0.0 : -std::copysign(made.way[i], made.pushed[i]);
    }
    return made;
  }
};

// (1), to the round-off of forming y.
void check_law(const Problem& problem, const Solution& solution) {
  const VectorXd& p = solution.p;
  const VectorXd y = problem.free + problem.reach * (problem.W * p);
  const VectorXd terms = problem.free.cwiseAbs() + problem.reach * (problem.W.cwiseAbs() * p.cwiseAbs());
  const auto m = static_cast<double>(p.size());
  CHECK(solution.outcome.converged);
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    INFO("point " << i << ": p = " << p[i] << ", y = " << y[i]);
    const double side = problem.pushed[i], error = 16 * m * epsilon * terms[i];
    if (side == 0) {
      CHECK(p[i] == 0);
      continue;
    }
    CHECK(p[i] * side >= 0);
    CHECK(y[i] * std::copysign(1, side) >= -error);
    CHECK(std::abs(p[i] * y[i] + problem.pushed[i] * problem.way[i]) <=
          error * (std::abs(p[i]) + std::abs(y[i]) / (problem.reach * problem.W(i, i))));
  }
}

}  // namespace

TEST_CASE("one point: the work is given back by the root on its side", "[restoring]") {
  const double W = 2.5, reach = 0.3;
  for (const double side : {1.0, -1.0})
    for (const double u : {-3.0, -1e-9, 0.0, 1e-9, 3.0})
      for (const double d : {0.0, 1e-14, 0.7, 1e9}) {
        INFO("side " << side << ", u = " << u << ", d = " << d);
        const Problem problem{MatrixXd::Constant(1, 1, W), VectorXd::Constant(1, u), VectorXd::Constant(1, side),
                              VectorXd::Constant(1, -side * d), reach};
        const Solution solution = solve(problem);
        check_law(problem, solution);
        const double root = std::sqrt(u * u + 4 * reach * W * d);
        // The textbook root cancels where s u is positive.
        CHECK(solution.p[0] == Approx(side * (-side * u + root) / (2 * reach * W)).epsilon(1e-12).margin(1e-15));
        CHECK(solution.outcome.iterations == 1);
      }
}

TEST_CASE("several points: each gives back its own work, whatever pushes beside it", "[restoring]") {
  for (const int m : {2, 3, 10, 40})
    for (unsigned seed = 0; seed < 40; ++seed) {
      INFO("m = " << m << ", seed " << seed);
      const Problem problem = Random(seed).problem(m, m + 2);
      const Solution solution = solve(problem);
      check_law(problem, solution);
      for (const int j : solution.asked) CHECK(problem.pushed[j] != 0);
      CHECK(solution.outcome.iterations < 40);
    }
}

TEST_CASE("Newton and the sweeps behind it find the same efforts", "[restoring]") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Problem problem = Random(seed).problem(4, 8);
    const Solution newton = solve(problem), swept = solve(problem, 0);
    INFO("seed " << seed);
    check_law(problem, swept);
    // Round-off through the condition of W.
    CHECK((newton.p - swept.p).norm() <= 1e-8 * newton.p.norm());
  }
}

TEST_CASE("points that depend on each other share their work", "[restoring]") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Problem problem = Random(seed).problem(5, 2);
    // Ways of dependent points follow from one motion: then their efforts can undo it.
    problem.free = problem.W * Random(seed + 100).vector(5);
    problem.way = problem.W * Random(seed + 200).vector(5);
    problem.pushed = -problem.way.cwiseSign().cwiseProduct(problem.pushed.cwiseAbs());
    INFO("seed " << seed);
    check_law(problem, solve(problem));
  }
}

TEST_CASE("scales of metres and newtons change nothing but the scale of the answer", "[restoring]") {
  const Problem problem = Random(5).problem(6, 8);
  Problem scaled = problem;
  const double length = 0x1p-40, force = 0x1p30;
  scaled.W *= length / force;
  scaled.free *= length;
  scaled.pushed *= force;
  scaled.way *= length;
  const Solution one = solve(problem), other = solve(scaled);
  CHECK(VectorXd(force * one.p) == other.p);
  CHECK(length * one.outcome.residual == other.outcome.residual);
}

TEST_CASE("work that contact gave cannot be given back: the solve says so", "[restoring]") {
  for (const int m : {1, 3}) {
    Problem problem = Random(2).problem(m, m + 1);
    problem.way[0] = std::copysign(1e-3, problem.pushed[0]);
    const Solution solution = solve(problem);
    CHECK_FALSE(solution.outcome.converged);
    CHECK(solution.outcome.residual == 1e-3);
    CHECK(solution.p == VectorXd::Zero(m));
    // Within what is not known of the way there is no work.
    problem.uncertainty = 2e-3;
    Problem at_rest = problem;
    at_rest.way[0] = 0;
    CHECK(solve(problem).p == solve(at_rest).p);
    check_law(at_rest, solve(problem));
  }
  // A point that nothing moves and that does not leave by itself.
  const Solution stuck =
      solve({MatrixXd::Zero(1, 1), VectorXd::Constant(1, -1), VectorXd::Constant(1, 1), VectorXd::Constant(1, -1)});
  CHECK_FALSE(stuck.outcome.converged);
  CHECK(stuck.p[0] == 0);
  Problem broken = Random(3).problem(3, 3);
  broken.free[1] = std::nan("");
  CHECK_FALSE(solve(broken).outcome.converged);
  CHECK(std::isinf(solve(broken).outcome.residual));
  CHECK(solve(broken).p == VectorXd::Zero(3));
}

TEST_CASE("a restoring solve allocates nothing and sees its own lane alone", "[restoring]") {
  constexpr int m = 6, lanes = 4;
  using Block = Eigen::Matrix<double, m, lanes, Eigen::RowMajor>;
  Block free, pushed, way, p = Block::Zero();
  std::vector<Problem> alone;
  for (int lane = 0; lane < lanes; ++lane) {
    alone.push_back(Random(11).problem(m, m));
    Problem own = Random(static_cast<unsigned>(lane)).problem(m, m);
    alone.back().free = own.free, alone.back().pushed = own.pushed, alone.back().way = own.way;
    free.col(lane) = own.free;
    pushed.col(lane) = own.pushed;
    way.col(lane) = own.way;
  }
  Columns columns(alone[0].W);
  columns.asked.reserve(1000);
  RestoringSolver solver;
  solver.prepare(m);
  for (int lane = lanes - 1; lane >= 0; --lane) {
    const RestoringSolver::Lane one{0.5, free.data() + lane, pushed.data() + lane, way.data() + lane, 0, lanes};
    const long before = allocations();
    solver.solve(columns, one, p.data() + lane, m);
    CHECK(allocations() == before);
  }
  for (int lane = 0; lane < lanes; ++lane)
    CHECK(VectorXd(p.col(lane)) == solve(alone[static_cast<std::size_t>(lane)]).p);
}

}  // namespace restoring_solver_tests
