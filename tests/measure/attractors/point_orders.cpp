// Orders and limits of special points whose law is known: v = x + c hᵖ, with noise inside the intervals.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <ricochet/measure/attractors/match_points.hpp>

using namespace ricochet;

namespace {

std::vector<PointLevel> levels(const std::vector<double>& sizes, const std::function<double(double)>& law,
                               double half = 0) {
  std::vector<PointLevel> out;
  for (const double size : sizes) out.push_back({size, law(size), half});
  return out;
}

std::vector<double> halved(int count, double coarsest = 1e-3) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k) out.push_back(coarsest * std::pow(0.5, k));
  return out;
}

}  // namespace

TEST_CASE("a point that moves with a power of the step shows that power and its limit") {
  for (const double p : {1.0, 2.0, 3.8})
    for (const auto& sizes : {halved(3), halved(5), std::vector<double>{1.0 / 10, 1.0 / 20, 1.0 / 50},
                              std::vector<double>{1.0 / 10, 1.0 / 15, 1.0 / 40, 1.0 / 60, 1.0 / 200}}) {
      INFO("p " << p << " over " << sizes.size() << " sizes from " << sizes.front());
      const double c = 0.01 / std::pow(sizes.front(), p);
      const auto given = levels(sizes, [&](double h) { return 0.1 + c * std::pow(h, p); });
      const PointOrder order = point_order(given);
      REQUIRE(order.order);
      // Differences of numbers near 0.1 carry a round-off of 1e-17 in differences of 1e-8 and more.
      CHECK(*order.order == Approx(p).epsilon(1e-6));
      CHECK(*order.low < p);
      CHECK(*order.high > p);
      CHECK(order.told);
      CHECK(order.used == sizes.size());
      const PointLimit limit = point_limit(given, order);
      CHECK(limit.value == Approx(0.1).epsilon(1e-9));
      REQUIRE(limit.open);
      CHECK(*limit.open == Approx(std::abs(limit.correction)));
    }
}

TEST_CASE("noise inside the intervals leaves the order in its interval and the limit within what is open") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-1, 1);
  const double half = 1e-6;
  int inside = 0, told = 0, limits = 0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    // Differences of 3e-3, 7.5e-4: the second is moved by a quarter of a percent at most.
    auto given = levels(halved(3), [](double h) { return 0.1 + 4e3 * h * h; });
    for (PointLevel& one : given) one.value += half * noise(random), one.half = half;
    const PointOrder order = point_order(given);
    told += order.told;
    inside += order.told && *order.low <= 2 && 2 <= *order.high;
    const PointLimit limit = point_limit(given, order);
    limits += std::abs(limit.value - 0.1) <= *limit.open + half;
  }
  // The interval of three sizes holds every noise that the intervals allow; half of the last correction is more.
  CHECK(told == trials);
  CHECK(inside == trials);
  CHECK(limits == trials);
}

TEST_CASE("an order needs three sizes whose differences stand above their intervals") {
  const auto square = [](double h) { return 0.1 + 4e3 * h * h; };
  CHECK_FALSE(point_order(levels(halved(2), square)).told);
  CHECK(point_order(levels(halved(2), square)).reason == "2 sizes, three are needed");
  CHECK_FALSE(point_order(levels(halved(1), square)).order);
  // Of three differences 3e-3, 7.5e-4, 1.9e-4 the last is less than four half intervals on both sides.
  const PointOrder two = point_order(levels(halved(4), square, 3e-5));
  CHECK(two.used == 3);
  CHECK(two.order);
  const PointOrder none = point_order(levels(halved(4), square, 2e-4));
  CHECK_FALSE(none.order);
  CHECK_FALSE(none.told);
  CHECK(none.reason == "1 of 3 differences are above their intervals and of one sign, two are needed");
}

TEST_CASE("differences that change sign or grow tell no order") {
  const PointOrder alternating = point_order({{1, 0.1, 0}, {0.5, 0.2, 0}, {0.25, 0.15, 0}});
  CHECK_FALSE(alternating.told);
  CHECK_FALSE(alternating.order);
  const PointOrder growing = point_order({{1, 0.1, 0}, {0.5, 0.2, 0}, {0.25, 0.5, 0}});
  CHECK(growing.order);
  CHECK_FALSE(growing.told);
  CHECK(growing.reason == "the differences do not fall for certain");
  // Without an order the limit is the finest value and what refinement still moves.
  const PointLimit limit = point_limit({{1, 0.1, 0}, {0.5, 0.2, 0}, {0.25, 0.15, 0}}, alternating);
  CHECK(limit.value == 0.15);
  CHECK(limit.correction == 0);
  CHECK(*limit.open >= 0.05);
}

TEST_CASE("values that agree within their intervals leave open what they differ by") {
  const std::vector<PointLevel> levels = {{1, 0.1, 1e-5}, {0.5, 0.100002, 1e-5}, {0.25, 0.100001, 1e-5}};
  const PointOrder order = point_order(levels);
  CHECK_FALSE(order.told);
  const PointLimit limit = point_limit(levels, order);
  CHECK(limit.status == LimitStatus::same);
  CHECK(*limit.open == Approx(2e-6));
}

TEST_CASE("one size leaves open what refinement moves") {
  const std::vector<PointLevel> one = {{1e-3, 0.1, 1e-6}};
  const PointLimit limit = point_limit(one, point_order(one));
  CHECK(limit.value == 0.1);
  CHECK_FALSE(limit.open);
  CHECK(limit.status == LimitStatus::one);
  CHECK_THROWS_AS(point_limit({}, PointOrder()), std::invalid_argument);
  CHECK_THROWS_AS(point_order({{0, 1, 0}, {1, 1, 0}, {2, 1, 0}}), std::invalid_argument);
  CHECK_THROWS_AS(point_order({{1, 1, -1}, {2, 1, 0}, {3, 1, 0}}), std::invalid_argument);
}

TEST_CASE("units and the order of the sizes do not change an order") {
  auto given = levels(
      halved(5), [](double h) { return 0.1 + 4e3 * h * h + 1e5 * h * h * h; }, 1e-9);
  const PointOrder order = point_order(given);
  REQUIRE(order.order);
  std::swap(given[0], given[3]);
  for (PointLevel& one : given) one.size *= 7, one.value *= 1e3, one.half *= 1e3;
  const PointOrder scaled = point_order(given);
  CHECK(*scaled.order == Approx(*order.order).epsilon(1e-9));
  CHECK(scaled.told == order.told);
}

TEST_CASE("a stiffness is a size as its compliance is") {
  // Shifts −1.1e-3, −1.1e-4, −1.1e-5 m at 1e4, 1e5, 1e6 N/m: order 1 in 1/κ.
  const auto given = levels(
      {1e-4, 1e-5, 1e-6}, [](double compliance) { return 0.1 - 11 * compliance; }, 1e-7);
  const PointOrder order = point_order(given);
  REQUIRE(order.told);
  CHECK(*order.order == Approx(1).epsilon(1e-9));
  CHECK(point_limit(given, order).value == Approx(0.1).epsilon(1e-12));
}
