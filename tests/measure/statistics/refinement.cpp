// What becomes of a value as it is refined: sequences whose limit is known.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <ricochet/measure/statistics/refinement.hpp>

using namespace ricochet;

namespace {

// v(h) = a + b hᵖ at n sizes of this ratio.
std::vector<SizedValue> power_law(double a, double b, double p, double ratio, int n) {
  std::vector<SizedValue> values;
  for (int k = 0; k < n; ++k) {
    const double h = std::pow(ratio, -k);
    values.push_back({h, a + b * std::pow(h, p)});
  }
  return values;
}

}  // namespace

TEST_CASE("an order is that of the power law, whatever the ratio of sizes") {
  for (const double ratio : {2.0, 10.0})
    for (const double p : {0.5, 1.0, 1.5, 2.0, 4.0}) {
      INFO("ratio " << ratio << ", order " << p);
      const auto v = power_law(3, 0.7, p, ratio, 3);
      const auto order = order_of(v[0].size, v[1].size, v[2].size, v[1].value - v[0].value, v[2].value - v[1].value);
      REQUIRE(order);
      // Differences keep eight digits at the least: 4 decades of order 4 at ratio 10.
      CHECK(*order == Approx(p).epsilon(1e-6));
    }
  CHECK_FALSE(order_of(1, 0.5, 0.25, 0, 1));
}

TEST_CASE("a sequence with an order settles on its limit within its uncertainty") {
  for (const double ratio : {2.0, 10.0})
    for (const double p : {0.6, 1.0, 2.0, 4.0}) {
      INFO("ratio " << ratio << ", order " << p);
      const auto limit = limit_of(power_law(3, 0.7, p, ratio, 4), 1e-15);
      REQUIRE(limit);
      CHECK(limit->status == LimitStatus::settles);
      REQUIRE(limit->order);
      CHECK(*limit->order == Approx(p).epsilon(1e-3));
      CHECK(std::abs(limit->value - 3) <= *limit->uncertainty * (1 + 1e-6));
    }
}

TEST_CASE("an interval holds the limit of what impacts leave within a step, and of two powers together") {
  // v = 1 + c h, c anew at each size: impacts are placed somewhere within a step, or always late. And v = 1 + c h +
  // d h², whose order changes on the way.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1, 1), late(0, 1);
  const auto held = [&](int sizes, bool by_chance, bool one_sided = false) {
    int settled = 0, inside = 0;
    for (int k = 0; k < 4000; ++k) {
      std::vector<SizedValue> values;
      const double c = anywhere(random), d = anywhere(random);
      for (int size = 0; size < sizes; ++size) {
        const double h = std::pow(2.0, -size);
        values.push_back({h, 1 + h * (one_sided ? late(random) : by_chance ? anywhere(random) : c + d * h)});
      }
      const auto limit = limit_of(values, 1e-15, {}, by_chance ? Errors::saw_toothed : Errors::smooth);
      REQUIRE(limit);
      if (limit->status != LimitStatus::settles) continue;
      ++settled;
      inside += std::abs(limit->value - 1) <= *limit->uncertainty ? 1 : 0;
    }
    REQUIRE(settled > 1000);
    return static_cast<double>(inside) / settled;
  };
  // What the order of three sizes leaves holds 88 of 100 that fall on both sides, 70 that fall on one.
  CHECK(held(3, true) > 0.97);
  CHECK(held(4, true) > 0.93);
  CHECK(held(3, true, true) > 0.91);
  CHECK(held(3, false) > 0.9);
  CHECK(held(5, false) > 0.88);
}

TEST_CASE("an interval without a confirmed order is as wide as a coarser one missed") {
  // A plateau of three sizes, left by the fourth: mean force of springs by the mid-point rule.
  const std::vector<double> values = {4.65, 4.60, 4.594, 4.71, 4.69};
  std::vector<SizedValue> sequence;
  for (std::size_t k = 0; k < values.size(); ++k) sequence.push_back({std::pow(0.5, k), values[k]});
  const auto early = limit_of({sequence.begin(), sequence.begin() + 3}, 1e-12), late = limit_of(sequence, 1e-12);
  REQUIRE((early && late));
  CHECK(early->status == LimitStatus::settles);
  CHECK(*early->uncertainty < 0.02);
  CHECK(*late->uncertainty >= 4.71 - 4.594);
  // Whatever the sequence: an interval that a later value missed is no measure of the last.
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 500; ++draw) {
    std::vector<SizedValue> one;
    for (int k = 0; k < 6; ++k) one.push_back({std::pow(0.5, k), 1 + std::pow(0.5, k) * 0.1 * normal(random)});
    const auto whole = limit_of(one, 1e-12);
    if (whole->status != LimitStatus::settles || whole->order) continue;
    for (std::size_t m = 3; m < one.size(); ++m) {
      const auto told = limit_of({one.begin(), one.begin() + static_cast<std::ptrdiff_t>(m)}, 1e-12);
      if (told->status != LimitStatus::settles) continue;
      for (std::size_t k = m; k < one.size(); ++k) {
        const double off = std::abs(one[k].value - told->value);
        CHECK((off <= *told->uncertainty || off <= *whole->uncertainty));
      }
    }
  }
}

TEST_CASE("statuses: one, same, two, moves, wanders, blows up, vanishes, reaches the truth") {
  const auto status = [](std::vector<double> values, std::optional<double> truth = {}, double floor = 1e-14) {
    std::vector<SizedValue> sized;
    for (std::size_t k = 0; k < values.size(); ++k) sized.push_back({std::pow(2, -static_cast<double>(k)), values[k]});
    return limit_of(sized, floor, truth)->status;
  };
  CHECK(status({1}) == LimitStatus::one);
  CHECK(status({1, 1, 1}) == LimitStatus::same);
  CHECK(status({1, 2}) == LimitStatus::two);
  CHECK(status({1, 2, 3}) == LimitStatus::moves);
  CHECK(status({1, 3, 1.2}) == LimitStatus::wanders);
  CHECK(status({1, 2, 5, 17}) == LimitStatus::blows_up);
  CHECK(status({1, 0.25, 0.0625}) == LimitStatus::vanishes);
  CHECK(status({0.9, 0.975, 0.99375}, 1.0) == LimitStatus::reaches_truth);
  CHECK(status({0.9, 1}, 1.0) == LimitStatus::reaches_truth);
  // It settles, but elsewhere.
  CHECK(status({0.9, 0.85, 0.8375}, 1.0) == LimitStatus::settles);
  CHECK_FALSE(limit_of({}, 0));
}

TEST_CASE("with a saw tooth a last step within the floor is no agreement") {
  const std::vector<SizedValue> values = {{4, 1.156}, {2, 1.141}, {1, 1.138}};
  CHECK(*limit_of(values, 0.004, {}, Errors::saw_toothed)->uncertainty == Approx(1.156 - 1.138));
  CHECK(*limit_of(values, 0.004)->uncertainty == Approx(0.004));
}

TEST_CASE("what grows as a power of the size has no limit, growth that slows down moves") {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> power(0.5, 2), offset(0, 0.5);
  for (int draw = 0; draw < 200; ++draw) {
    const double p = power(random), c = offset(random);
    std::vector<SizedValue> powers;
    for (int k = 0; k < 4; ++k) powers.push_back({std::pow(10, -k), c + std::pow(10, k * p)});
    CHECK(limit_of(powers, 0)->status == LimitStatus::blows_up);
  }
  // A share that tends to 1.
  const auto slows = limit_of({{1, 0.008}, {0.1, 0.09}, {0.01, 0.30}, {0.001, 0.55}}, 0);
  CHECK(slows->status == LimitStatus::moves);
  CHECK((slows->low <= 1 && 1 <= slows->high));
  // A share of 1 that is far below it.
  auto small = limit_of({{1, 1e-9}, {0.5, 1e-8}, {0.25, 1e-7}}, 0);
  bound_growth(*small, 1e-8);
  CHECK(small->status == LimitStatus::blows_up);
  bound_growth(*small, 1);
  CHECK(small->status == LimitStatus::moves);
  CHECK(*small->uncertainty == Approx(2 * (1e-7 - 1e-9)));
  CHECK(small->high == Approx(small->value + *small->uncertainty));
}

TEST_CASE("scaling values scales the limit, and changes no status") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 200; ++draw) {
    std::vector<SizedValue> values, larger;
    const int n = 1 + draw % 6;
    for (int k = 0; k < n; ++k) {
      const double value = normal(random);
      values.push_back({std::pow(2, -k), value});
      larger.push_back({std::pow(2, -k), 1024 * value});
    }
    const auto one = limit_of(values, 0), other = limit_of(larger, 0);
    CHECK(one->status == other->status);
    CHECK(1024 * one->value == other->value);
    if (one->uncertainty && std::isfinite(*one->uncertainty)) CHECK(1024 * *one->uncertainty == *other->uncertainty);
  }
}

TEST_CASE("over two refinements uncertainties are added, and the worse status stands") {
  const auto step = limit_of(power_law(3, 0.1, 2, 2, 4), 0), two = limit_of({{1, 3}, {0.5, 3.1}}, 0),
             wanders = limit_of({{1, 3}, {0.5, 4}, {0.25, 3.1}}, 0), one = limit_of({{1, 3}}, 0);
  CHECK(*combined(step, two)->uncertainty == Approx(*step->uncertainty + *two->uncertainty));
  // Low and high are as far as both say together.
  CHECK(combined(step, two)->low == Approx(step->low - (two->value - two->low)));
  CHECK(combined(step, two)->high == Approx(step->high + two->high - two->value));
  CHECK(combined(step, two)->status == LimitStatus::settles);
  CHECK(combined(step, wanders)->status == LimitStatus::wanders);
  CHECK(combined(step, one)->uncertainty == step->uncertainty);
  CHECK(combined(one, two)->status == LimitStatus::two);
  CHECK_FALSE(combined({}, {}));
}

TEST_CASE("where most methods are restless, three values that settle are chance") {
  auto settles = *limit_of({{1, 1.0}, {0.5, 1.5}, {0.25, 1.6}}, 0);
  auto wanders = *limit_of({{1, 3}, {0.5, 4}, {0.25, 3.1}}, 0), moves = *limit_of({{1, 1}, {0.5, 2}, {0.25, 3}}, 0);
  doubt_chance({&settles, &wanders, &moves});
  CHECK(settles.status == LimitStatus::moves);
  CHECK(*settles.uncertainty == Approx(0.6));
  auto firm = *limit_of({{1, 1.0}, {0.5, 1.5}, {0.25, 1.6}}, 0), second = firm;
  doubt_chance({&firm, &second, &wanders});
  CHECK(firm.status == LimitStatus::settles);
}

// The order over the longest run of slopes that agree.

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

TEST_CASE("two slopes alone that are steeper than any scheme's are no clean order") {
  const auto of = [](double p, std::size_t sizes) {
    std::vector<SizedValue> errors;
    for (std::size_t k = 0; k < sizes; ++k)
      errors.push_back({std::pow(0.5, k), std::pow(0.5, p * static_cast<double>(k))});
    return order_run(errors, 0)->clean();
  };
  CHECK(of(2, 3));
  CHECK(of(3, 3));
  CHECK_FALSE(of(4.2, 3));
  CHECK(of(4, 5));
}

TEST_CASE("values that fall together by chance are known to what coarser steps are off by, as it falls with the step") {
  // A ball that bounces with e = 0.7: its impulse at four steps, and in truth 2.406985 N s or so far from three that
  // agree.
  const std::vector<SizedValue> values = {{4e-4, 2.4103}, {2e-4, 2.40731}, {1e-4, 2.40728}, {5e-5, 2.4073}};
  const auto limit = limit_of(values, 0, {}, Errors::saw_toothed);
  REQUIRE(limit);
  CHECK(*limit->uncertainty >= (2.4103 - 2.4073) / 8);
  CHECK(limit->low <= 2.406985);
}

TEST_CASE("two slopes that agree among errors that rise as far are no clean order") {
  // Newmark at a rigid stop: what the phase of a step makes of an impact.
  const auto wild = order_run(
      {{1, 0.09}, {0.5, 0.36}, {0.25, 0.19}, {0.125, 0.44}, {0.0625, 0.37}, {0.03125, 0.22}, {0.015625, 0.13}}, 0);
  CHECK_FALSE(wild->clean());
  // The same fall alone.
  CHECK(order_run({{1, 0.37}, {0.5, 0.22}, {0.25, 0.13}}, 0)->clean());
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

TEST_CASE("orders that agree confirm no limit of what errs by saw teeth") {
  const std::vector<SizedValue> values = {{16, 1.4}, {8, 1.2}, {4, 1.1}, {2, 1.05}, {1, 1.025}};
  const auto smooth = limit_of(values, 0, {}, Errors::smooth), teeth = limit_of(values, 0, {}, Errors::saw_toothed);
  REQUIRE((smooth && teeth));
  CHECK(smooth->order);
  CHECK(*smooth->uncertainty < smooth->range);
  CHECK_FALSE(teeth->order);
  CHECK(*teeth->uncertainty >= teeth->range);
}
