// The order over the longest run of slopes that agree.
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/statistics/order_run.hpp>

using namespace ricochet;

namespace {

std::vector<SizedValue> errors_of(double p, double level, int n) {
  std::vector<SizedValue> out;
  for (int k = 0; k < n; ++k) out.push_back({std::pow(2, -k), std::max(std::pow(2, -p * k), level)});
  return out;
}

}  // namespace

TEST_CASE("a power law has its order over all of its sizes") {
  for (const double p : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0}) {
    INFO("order " << p);
    const auto run = order_run(errors_of(p, 0, 6), 0);
    REQUIRE(run);
    CHECK(run->verdict == OrderRun::Verdict::order);
    CHECK(run->order == Approx(p));
    CHECK(order_class(run->order) == p);
    CHECK_FALSE(run->stops_at);
  }
}

TEST_CASE("a fall that ends at a level stops there, never above the smallest error") {
  const auto run = order_run(errors_of(2, 1e-3, 10), 0);
  CHECK(run->verdict == OrderRun::Verdict::order);
  REQUIRE(run->stops_at);
  CHECK(*run->stops_at == run->smallest);
}

TEST_CASE("errors that do not fall, jump about, or lie at the floor have no order") {
  CHECK(order_run({{1, 1}, {0.5, 1.1}, {0.25, 0.95}}, 0)->verdict == OrderRun::Verdict::does_not_fall);
  CHECK(order_run({{1, 1}, {0.5, 0.1}, {0.25, 0.09}, {0.125, 0.001}}, 0)->verdict ==
        OrderRun::Verdict::no_steady_order);
  CHECK(order_run({{1, 1e-9}, {0.5, 2e-9}, {0.25, 1e-9}}, 1e-9)->verdict == OrderRun::Verdict::below_floor);
  CHECK(order_run({{1, 1}, {0.5, 0.5}}, 0)->verdict == OrderRun::Verdict::too_few);
  CHECK_FALSE(order_run({}, 0));
}

TEST_CASE("two slopes that agree before the finest errors may be chance, and are said to be in passing") {
  // Slopes 2, 2, 0, 0: the level is met after two.
  const auto passing = order_run({{1, 1}, {0.5, 0.25}, {0.25, 0.0625}, {0.125, 0.0625}, {0.0625, 0.0625}}, 0);
  CHECK(passing->verdict == OrderRun::Verdict::order);
  CHECK(passing->in_passing);
  // To the finest, over three slopes, or most of all slopes.
  CHECK_FALSE(order_run({{1, 1}, {0.5, 0.25}, {0.25, 0.0625}, {0.125, 0.0625}}, 0)->in_passing);
  CHECK_FALSE(order_run({{1, 1}, {0.5, 0.25}, {0.25, 0.0625}}, 0)->in_passing);
  CHECK_FALSE(order_run(errors_of(2, 1e-3, 10), 0)->in_passing);
}
