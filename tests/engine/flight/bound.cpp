/// Bounds of steps of two slots, whose roots have a closed form: whatever the roots are, they hold, or say why not.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <ricochet/engine/flight/flight_bound.hpp>

using namespace ricochet;
using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

/// x⁺ = A x of one mode, and its first slot unbounded.
FlightBound bound_of(const Matrix2d& A) {
  FlightStage stage;
  for (int j = 0; j < 2; ++j) {
    Combination update;
    update.slots = {A(j, 0), A(j, 1)};
    stage.update.push_back(update);
  }
  stage.force = Eigen::MatrixXd::Zero(1, 0);
  const StepRows rows({stage}, 2, Eigen::VectorXd::Ones(1), {}, {});
  FlightWatch watch;
  watch.value.slots = {1, 0};
  watch.rows = Eigen::MatrixXd::Ones(1, 1);
  watch.drive = Eigen::MatrixXd::Zero(1, 0);
  watch.lower = {-1};
  watch.upper = {1};
  return {rows, {watch}};
}

/// T J T⁻¹: the roots of J, seen by slots of other sizes that share them.
Matrix2d seen(const Matrix2d& J, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Matrix2d T;
  do {
    for (double& one : T.reshaped()) one = normal(random);
  } while (std::abs(T.determinant()) < 0.2);
  const Matrix2d sizes = Vector2d(1, std::pow(10.0, 3 * normal(random))).asDiagonal();
  return sizes * T * J * T.inverse() * sizes.inverse();
}

Matrix2d turning(double size, double angle) {
  Matrix2d J;
  J << size * std::cos(angle), size * std::sin(angle), -size * std::sin(angle), size * std::cos(angle);
  return J;
}

Matrix2d real_roots(double one, double other, double above = 0) {
  Matrix2d J;
  J << one, above, 0, other;
  return J;
}

/// How much of the bound the motion uses.
double check_holds(const Matrix2d& A, std::mt19937& random) {
  FlightBound bound = bound_of(A);
  CAPTURE(A, bound.cause());
  REQUIRE(bound.cause().empty());
  std::normal_distribution<double> normal;
  Vector2d x(normal(random), normal(random) * (A(0, 1) != 0 ? 1 / std::abs(A(0, 1)) : 1));
  const double none = 0;
  bound.set_state(x.data(), &none);
  const long long k = std::min<long long>(200, bound.longest());
  const FlightBound::Range range = bound.range(0, 0, k);
  double low = x[0], high = x[0];
  for (long long i = 0; i < k; ++i) {
    x = A * x;
    low = std::min(low, x[0]);
    high = std::max(high, x[0]);
  }
  CHECK(low >= range.low);
  CHECK(high <= range.high);
  return (high - low) / (range.high - range.low);
}

}  // namespace

TEST_CASE("a bound of two slots holds whatever its two roots are") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(0, 1);
  double used = 0;
  constexpr int draws = 200;
  for (int draw = 0; draw < draws; ++draw) {
    const double angle = std::numbers::pi * part(random), size = 0.2 + 0.8 * part(random);
    used += check_holds(seen(turning(1, angle), random), random);
    used += check_holds(seen(turning(size, angle), random), random);
    used += check_holds(seen(real_roots(size, -0.9 * size), random), random);
    used += check_holds(seen(real_roots(-1, 0.5 * size), random), random);
    used += check_holds(seen(real_roots(size, 0), random), random);
  }
  // Slow ones, as fine steps have them: the change of a step is what tells their roots.
  for (const double angle : {1e-3, 1e-5, 1e-7}) used += check_holds(seen(turning(1, angle), random), random);
  CHECK(used > 0.3 * 5 * draws);
}

TEST_CASE("a bound of two slots holds where one does not reach the other, and where both are over at once") {
  std::mt19937 random(12);
  check_holds(real_roots(0.5, -0.25), random);
  check_holds(real_roots(0.5, -0.25, 3), random);
  check_holds(real_roots(0.5, -0.25, 3).transpose(), random);
  check_holds(real_roots(0, 0), random);
  check_holds(real_roots(0, 0, 1), random);
  check_holds(real_roots(0.5, 0.5), random);
  check_holds(real_roots(-1, -1), random);
  check_holds(real_roots(0.5, 0.5, 2), random);
  check_holds(real_roots(-1, -1, 0.25), random);
}

TEST_CASE("two slots of which one grows have no bound") {
  std::mt19937 random(13);
  for (const Matrix2d& J : {turning(1.001, 0.3), real_roots(1.01, 0.2), real_roots(-1.001, 0.9), real_roots(1, 1, 1)}) {
    const FlightBound bound = bound_of(seen(J, random));
    CAPTURE(J, bound.cause());
    CHECK_FALSE(bound.cause().empty());
  }
}
