// Coulomb friction with given bounds: what its efforts must be, whatever the problem.
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/contact_solvers/friction_solver.hpp>

using namespace ricochet;

namespace {

struct Made {
  Eigen::MatrixXd A;  // symmetric: row by row as well
  Eigen::VectorXd free, bound, start;
  std::vector<int> first{0};
  Eigen::VectorXd effort;
  std::vector<unsigned char> sticks;
  std::vector<double> slid;

  LaneOutcome solve(const double* held = nullptr) {
    const int points = static_cast<int>(bound.size()), rows = static_cast<int>(free.size());
    FrictionSolver solver;
    solver.prepare(points, rows);
    effort = start;
    sticks.assign(static_cast<std::size_t>(points), 0);
    slid.assign(static_cast<std::size_t>(points), 0);
    FrictionProblem problem;
    problem.points = points;
    problem.first_row = first.data();
    problem.matrix = A.data();
    problem.stride = rows;
    problem.free = free.data();
    problem.bound = bound.data();
    problem.bound_static = held;
    problem.effort = effort.data();
    problem.sticks = sticks.data();
    problem.slid = slid.data();
    return solver.solve(problem);
  }
  Eigen::VectorXd rate() const { return free + A * effort; }
  auto of(const Eigen::VectorXd& x, int point) const {
    return x.segment(first[static_cast<std::size_t>(point)],
                     first[static_cast<std::size_t>(point) + 1] - first[static_cast<std::size_t>(point)]);
  }
};

// `rank`: of A, at most the rows.
Made random_problem(std::mt19937& random, int points, int rows_of_each, int rank) {
  std::uniform_real_distribution<double> any(-1, 1), share(0, 1);
  Made made;
  const int rows = points * rows_of_each;
  const Eigen::MatrixXd B = Eigen::MatrixXd::NullaryExpr(rank, rows, [&] { return any(random); });
  made.A = B.transpose() * B;
  made.free = B.transpose() * Eigen::VectorXd::NullaryExpr(rank, [&] { return 3 * any(random); });
  made.bound = Eigen::VectorXd::NullaryExpr(points, [&] { return std::pow(10, 3 * any(random)); });
  for (int i = 1; i <= points; ++i) made.first.push_back(i * rows_of_each);
  made.start = Eigen::VectorXd::NullaryExpr(rows, [&] { return any(random); });
  return made;
}

// |p| ≤ s, u = 0 within, and −u along p at the bound.
void check_law(const Made& made) {
  const Eigen::VectorXd u = made.rate();
  const double size = made.free.norm() + (made.A * made.effort).norm();
  for (int i = 0; i < made.bound.size(); ++i) {
    const Eigen::VectorXd p = made.of(made.effort, i), v = made.of(u, i);
    CHECK(p.norm() <= made.bound[i] * (1 + 1e-12));
    // Efforts are known to 1e-12 of the largest bound, rates to what that moves.
    const double near = 1e-10 * (size + made.A.norm() * made.bound.maxCoeff());
    if (made.sticks[static_cast<std::size_t>(i)] != 0) {
      CHECK(v.norm() <= near);
      CHECK(made.slid[static_cast<std::size_t>(i)] == 0);
    } else {
      CHECK(p.norm() == Approx(made.bound[i]).epsilon(1e-12));
      CHECK((p * v.norm() + v * p.norm()).norm() <= near * made.bound[i]);
      CHECK(made.slid[static_cast<std::size_t>(i)] == Approx(v.norm()).margin(near));
    }
  }
}

}  // namespace

TEST_CASE("friction of given bounds: within its disc, at rest inside it, against the motion on it", "[friction]") {
  std::mt19937 random(7);
  const int rows = GENERATE(1, 2), points = GENERATE(1, 2, 5);
  for (int k = 0; k < 200; ++k) {
    Made made = random_problem(random, points, rows, points * rows);
    const LaneOutcome outcome = made.solve();
    REQUIRE(outcome.converged);
    CHECK(outcome.residual <= 1e-12);
    check_law(made);
  }
}

TEST_CASE("friction of given bounds: efforts do not depend on where they are looked for", "[friction]") {
  std::mt19937 random(11);
  for (int k = 0; k < 200; ++k) {
    Made made = random_problem(random, 3, 1 + k % 2, 3 * (1 + k % 2));
    made.A.diagonal().array() += 0.01;
    made.solve();
    const Eigen::VectorXd found = made.effort;
    made.start = -5 * made.start;
    made.solve();
    // 1e-12 of the largest bound, over a conditioning of 1e3 at most.
    CHECK((found - made.effort).norm() <= 1e-9 * made.bound.maxCoeff());
  }
}

TEST_CASE("friction of given bounds: points at one place share what only their sum knows", "[friction]") {
  std::mt19937 random(13);
  for (int k = 0; k < 100; ++k) {
    Made one = random_problem(random, 1, 2, 2), two = one;
    two.A = one.A.replicate(2, 2);
    two.free = one.free.replicate(2, 1);
    two.bound = Eigen::Vector2d::Constant(0.5 * one.bound[0]);
    two.start = one.start.replicate(2, 1);
    two.first = {0, 2, 4};
    one.solve();
    REQUIRE(two.solve().converged);
    CHECK((two.effort.head(2) + two.effort.tail(2) - one.effort).norm() <= 1e-9 * one.bound[0]);
  }
}

TEST_CASE("friction of given bounds: no direction is special, and no unit", "[friction]") {
  std::mt19937 random(17);
  for (int k = 0; k < 100; ++k) {
    Made made = random_problem(random, 1, 2, 2), turned = made, scaled = made;
    const Eigen::Rotation2Dd turn(0.7 * k);
    turned.A = turn.toRotationMatrix() * made.A * turn.toRotationMatrix().transpose();
    turned.free = turn * Eigen::Vector2d(made.free);
    scaled.A *= 20.0 / 3;
    scaled.free *= 20;
    scaled.bound *= 3;
    for (Made* one : {&made, &turned, &scaled}) one->solve();
    CHECK((turned.effort - turn * Eigen::Vector2d(made.effort)).norm() <= 1e-11 * made.bound[0]);
    CHECK((scaled.effort - 3 * made.effort).norm() <= 1e-11 * made.bound[0]);
  }
}

TEST_CASE("friction of given bounds: what gives way at its static bound slides at the other", "[friction]") {
  Made made;
  made.A = Eigen::MatrixXd::Identity(1, 1);
  made.bound = Eigen::VectorXd::Constant(1, 2);
  made.first = {0, 1};
  made.start = Eigen::VectorXd::Zero(1);
  const double held = 3;
  for (const auto& [free, effort] : {std::pair(2.9, -2.9), {3.1, -2.0}, {-3.1, 2.0}, {1.0, -1.0}}) {
    made.free = Eigen::VectorXd::Constant(1, free);
    made.solve(&held);
    CHECK(made.effort[0] == effort);
  }
  made.free[0] = 2.9;
  made.solve();
  CHECK(made.effort[0] == -2);
}

TEST_CASE("friction without a bound is none", "[friction]") {
  std::mt19937 random(19);
  Made made = random_problem(random, 3, 2, 6);
  made.bound.setZero();
  REQUIRE(made.solve().converged);
  CHECK(made.effort.isZero(0));
}
