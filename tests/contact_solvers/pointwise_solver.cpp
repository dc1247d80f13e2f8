#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/pointwise_solver.hpp>

#include "tests/contact_solvers/pointwise_problems.hpp"

namespace pointwise_solver_tests {

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

}  // namespace pointwise_solver_tests
