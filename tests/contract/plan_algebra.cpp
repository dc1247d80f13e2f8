// Combinations of slots, operators and times obey the laws of a vector space, and their weights are those of the
// formula.
#include <catch2/catch.hpp>
#include <ricochet/contract/plan_algebra.hpp>

using namespace ricochet;
using namespace ricochet::plan_algebra;

namespace plan_algebra_tests {
namespace {

std::vector<double> weights(const Combination& c) {
  std::vector<double> all = c.slots;
  while (!all.empty() && all.back() == 0) all.pop_back();
  all.insert(all.begin(), {c.z, c.w});
  return all;
}
std::vector<double> weights(const History& rows) {
  std::vector<double> all;
  for (const OperatorWeights& row : rows) all.insert(all.end(), {row.M, row.C, row.K});
  while (!all.empty() && all.back() == 0) all.pop_back();
  return all;
}
std::vector<double> weights(const Levels& levels) {
  std::vector<double> all;
  for (const Level& level : levels) all.insert(all.end(), {level.at, level.weight});
  return all;
}

// Products and sums of such numbers are exact.
constexpr double factors[] = {-3, -0.5, 0, 0.25, 7};

}  // namespace

TEST_CASE("factors distribute over sums of slots and unknowns") {
  const auto [q, v, a] = slots<3>();
  const Combination x = q + 0.5 * v - 3 * z, y = 2 * a + w - 0.25 * q;
  for (const double s : factors) {
    CHECK(weights(s * (x + y)) == weights(s * x + s * y));
    CHECK(weights(s * (x - y)) == weights(s * x - s * y));
    for (const double t : factors) CHECK(weights((s + t) * x) == weights(s * x + t * x));
  }
  CHECK(weights(x + y) == weights(y + x));
  CHECK(weights(x - x) == weights(Combination{}));
  CHECK(weights(-x) == weights(-1.0 * x));
  CHECK(weights(x / 4) == weights(0.25 * x));
  CHECK(weights(known(x)) == weights(q + 0.5 * v));
}

TEST_CASE("operators act on combinations linearly in both") {
  const auto [q, v, a] = slots<3>();
  const Combination x = q + 0.5 * v, y = 2 * a - 0.25 * q;
  for (const double s : factors) {
    const OperatorWeights A = M + s * C - 2 * K, B = 0.5 * K - C / 4;
    CHECK(weights(A * (x + y)) == weights(A * x + A * y));
    CHECK(weights((A + B) * x) == weights(A * x + B * x));
    CHECK(weights(s * A * x) == weights(A * (s * x)));
    CHECK(weights(-(A * x)) == weights(-A * x));
    CHECK(weights(A * x - B * y) == weights(A * x + -(B * y)));
  }
}

TEST_CASE("an equation gives S what it weighs of z, and b the rest with its sign changed") {
  const auto [q, v] = slots<2>();
  const Combination next = q + 0.5 * v + 0.25 * z, rate = v + 2 * z;
  const Stage stage = equation(8 * M * z + 0.5 * (C * rate) - K * next, 0.25 * at(0) + 0.75 * at(1));
  CHECK(stage.matrix.M == 8);
  CHECK(stage.matrix.C == 1);
  CHECK(stage.matrix.K == -0.25);
  CHECK(weights(stage.history) == weights(K * (q + 0.5 * v) - 0.5 * C * v));
  CHECK(weights(stage.load) == weights(0.25 * at(0) + 0.75 * at(1)));
  CHECK_FALSE(stage.impact);
  CHECK(stage.update.empty());
}

TEST_CASE("times keep their order, and the same time twice stays twice") {
  const Levels mean = 0.25 * at(0) + 0.75 * at(1) - at(0);
  CHECK(weights(mean) == std::vector<double>{0, 0.25, 1, 0.75, 0, -1});
}

TEST_CASE("Newmark's updates have the weights of his formulas, bit for bit") {
  const auto [q, v, a] = slots<3>();
  const double h = 7.3e-5, beta = 0.3025, gamma = 0.6;
  const Combination next = q + h * v + (0.5 - beta) * h * h * a + beta * h * h * z;
  CHECK(next.slots == std::vector<double>{1, h, (0.5 - beta) * h * h});
  CHECK(next.z == beta * h * h);
  CHECK(next.w == 0);
  const OperatorWeights S = M + gamma * h * C + beta * h * h * K;
  CHECK(S.M == 1);
  CHECK(S.C == gamma * h);
  CHECK(S.K == beta * h * h);
  const QuadraticTerm kinetic = square(EnergyMatrix::M, 0.5, v);
  CHECK(kinetic.coefficient == 0.5);
  CHECK(kinetic.slots == std::vector<double>{0, 1});
}

}  // namespace plan_algebra_tests
