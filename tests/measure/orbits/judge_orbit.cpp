// The 0–1 test on maps of which one knows what they do.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <vector>

using namespace ricochet;

namespace zero_one_test_tests {

namespace {

std::vector<double> logistic(double r, int count, double x = 0.4) {
  std::vector<double> series;
  for (int k = 0; k < 3000; ++k) x = r * x * (1 - x);
  for (int k = 0; k < count; ++k) series.push_back(x = r * x * (1 - x));
  return series;
}

std::vector<double> sampled(int count, const std::function<double(int)>& x) {
  std::vector<double> series;
  for (int k = 0; k < count; ++k) series.push_back(x(k));
  return series;
}

double K(const std::vector<double>& series, std::uint64_t seed = 1) {
  const auto found = zero_one_test(series, seed);
  REQUIRE(found);
  return *found;
}

}  // namespace

TEST_CASE("0–1 test: periodic and quasi-periodic series are regular, chaotic ones are not") {
  // Gottwald and Melbourne show K within a few percent of 0 and 1 for these; the classes need 0.2 and 0.8.
  for (const int count : {300, 1000, 3000}) {
    INFO(count << " readings");
    for (const double r : {3.2, 3.5, 3.55, 3.83, 3.7389}) CHECK(std::abs(K(logistic(r, count))) < 0.1);
    for (const double r : {3.7, 3.9, 3.97, 4.0}) CHECK(K(logistic(r, count)) > 0.9);
    for (const double rotation : {std::numbers::phi, std::numbers::sqrt2, 0.1234})
      CHECK(std::abs(K(sampled(count, [&](int k) { return std::cos(2 * std::numbers::pi * rotation * k); }))) < 0.1);
  }
}

TEST_CASE("0–1 test: two rotations of the circle map, before and after it is invertible") {
  // θ ← θ + Ω − k/(2π) sin 2πθ is quasi-periodic for small k and the golden Ω. It is chaotic at k = 6 for this Ω: the
  // sign of its exponent, Σ ln|1 − k cos 2πθ|/N, is checked to be clear.
  for (const double k : {0.3, 6.0}) {
    double theta = 0.1, exponent = 0;
    const auto series = sampled(2000, [&](int) {
      exponent += std::log(std::abs(1 - k * std::cos(2 * std::numbers::pi * theta))) / 2000;
      theta += std::numbers::phi - k / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi * theta);
      return std::sin(2 * std::numbers::pi * theta);
    });
    INFO("k = " << k << ", exponent " << exponent);
    if (k < 1) {
      CHECK(std::abs(exponent) < 0.01);
      CHECK(std::abs(K(series)) < 0.1);
    } else {
      CHECK(exponent > 0.3);
      CHECK(K(series) > 0.9);
    }
  }
}

TEST_CASE("0–1 test: neither units nor an offset matter, nor noise of a percent on what is regular") {
  const auto chaotic = logistic(4, 400);
  const auto moved = [&](double scale, double offset) {
    return sampled(400, [&](int k) { return scale * chaotic[static_cast<std::size_t>(k)] + offset; });
  };
  const double K0 = K(chaotic);
  // Round-off: the offset costs 1e-12 of the digits.
  for (const double scale : {1e-6, -1.0, 1e6}) CHECK(K(moved(scale, 0)) == Approx(K0).epsilon(1e-9));
  CHECK(K(moved(1, 1e3)) == Approx(K0).epsilon(1e-6));
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 0.01);
  CHECK(std::abs(K(sampled(1000, [&](int k) { return std::cos(1.2345 * k) + noise(random); }))) < 0.2);
}

TEST_CASE("0–1 test: the seed decides everything and hardly matters") {
  const auto series = logistic(3.9, 500);
  CHECK(K(series, 7) == K(series, 7));
  CHECK(K(series, 7) != K(series, 8));
  CHECK(K(series, 7) == Approx(K(series, 8)).margin(0.02));  // medians of two sets of 100 frequencies
}

TEST_CASE("0–1 test: a constant series is regular, short and broken ones have no answer") {
  CHECK(K(std::vector<double>(100, 0.3)) == 0);
  CHECK(K(std::vector<double>(100, 0.0)) == 0);
  CHECK(K(sampled(100, [](int k) { return 0.3 + 1e-16 * (k % 3); })) == 0);
  CHECK_FALSE(zero_one_test(logistic(4, 59)));
  CHECK(zero_one_test(logistic(4, 60)));
  auto broken = logistic(4, 300);
  broken[200] = std::numeric_limits<double>::infinity();
  CHECK_FALSE(zero_one_test(broken));
}

}  // namespace zero_one_test_tests

// What the kept periods of an orbit say, told of orbits that were never marched.
using namespace ricochet;

namespace judge_orbit_tests {

namespace {

SectionPlan plan_of_section() {
  SectionPlan plan;
  plan.pulsation = 10;
  plan.steps_per_period = 100;
  plan.keep = 80;
  plan.scale = 0.1;
  return plan;
}

/// Complete, with strobes that repeat every `period`; `image`: what the mirrored orbit shows at strobe k.
Orbit kept(int period, double (*image)(double), bool contact = true) {
  Orbit orbit;
  orbit.stage = Orbit::Stage::complete;
  orbit.settled = true;
  orbit.readings.width = 4;
  for (int k = 0; k < 80; ++k) {
    const double x = 0.02 + 0.03 * (k % period);
    orbit.strobed.push_back({x, 0.1, image(x), image(0.1)});
    orbit.readings.values.insert(orbit.readings.values.end(), {x, 0.1, image(x), image(0.1)});
    orbit.impact_counts.push_back(contact ? 2 : 0);
  }
  orbit.kept_periods = 80;
  orbit.contact_steps = contact ? 160 : 0;
  return orbit;
}

double same(double x) {
  return x;
}
double other(double x) {
  return x - 0.05;
}

}  // namespace

TEST_CASE("judging an orbit: its class, whether it is its own image, how often it strikes") {
  const SectionPlan plan = plan_of_section();
  for (const int period : {1, 3}) {
    const JudgedOrbit judged = judge(kept(period, same), plan, std::nullopt);
    CHECK(judged.verdict.motion == MotionClass{Regime::periodic, period});
    CHECK(judged.verdict.period == period);
    CHECK(judged.symmetric == true);
    CHECK(judge(kept(period, other), plan, std::nullopt).symmetric == false);
  }
  CHECK(impacts_per_period(kept(1, same)) == 2);
  CHECK(impacts_per_period(Orbit{}) == 0);
  // Without contact it repeats as well, and its class says no period.
  const JudgedOrbit open = judge(kept(2, same, false), plan, std::nullopt);
  CHECK(open.verdict.motion == MotionClass{Regime::no_contact, 0});
  CHECK(open.verdict.period == 2);
}

TEST_CASE("the rough class of an orbit is its class where it repeats or never touches") {
  const SectionPlan plan = plan_of_section();
  for (const int period : {1, 2, 5})
    for (const bool contact : {true, false}) {
      const Orbit orbit = kept(period, same, contact);
      CHECK(rough_class(orbit, plan) == judge(orbit, plan, std::nullopt).verdict.motion);
    }
  Orbit wandering = kept(1, same);
  for (std::size_t k = 0; k < 80; ++k)
    wandering.readings.values[4 * k] = 0.05 * std::sin(2.399963 * static_cast<double>(k * k));
  CHECK(rough_class(wandering, plan) == MotionClass{Regime::undecided, 0});
  Orbit stopped = kept(1, same);
  stopped.stage = Orbit::Stage::stopped;
  CHECK_FALSE(rough_class(stopped, plan));
  CHECK_FALSE(judge(stopped, plan, std::nullopt).verdict.motion.decided());
}

TEST_CASE("of an orbit whose end alone is kept class, period and the points of what repeats are left, and no state") {
  const SectionPlan plan = plan_of_section();
  for (const int period : {1, 3}) {
    Orbit orbit = kept(period, other);
    orbit.now.slots = {1, 2, 3};
    orbit.entry.slots = {1, 2};
    const Orbit before = orbit;
    keep_end(orbit, plan);
    REQUIRE(orbit.verdict);
    CHECK(orbit.verdict->motion == judge(before, plan, std::nullopt).verdict.motion);
    CHECK(orbit.verdict->period == period);
    REQUIRE(orbit.strobed.size() == static_cast<std::size_t>(period));
    CHECK(orbit.readings.width == 1);
    for (std::size_t k = 0; k < orbit.strobed.size(); ++k) {
      const std::size_t at = before.strobed.size() - orbit.strobed.size() + k;
      CHECK(orbit.strobed[k].displacement == before.strobed[at].displacement);
      CHECK(orbit.readings.values[k] == before.readings.values[4 * at]);
    }
    CHECK((orbit.now.slots.empty() && orbit.entry.slots.empty() && orbit.impact_counts.empty()));
    // Once more: what is left is not judged again, from what is left.
    keep_end(orbit, plan);
    CHECK(orbit.strobed.size() == static_cast<std::size_t>(period));
  }
  Orbit wandering = kept(1, same);
  for (std::size_t k = 0; k < 80; ++k)
    wandering.readings.values[4 * k] = 0.05 * std::sin(2.399963 * static_cast<double>(k * k));
  keep_end(wandering, plan);
  CHECK(wandering.verdict->period == 0);
  CHECK(wandering.strobed.size() == static_cast<std::size_t>(longest_end));
  Orbit stopped = kept(1, same);
  stopped.stage = Orbit::Stage::stopped;
  stopped.stopped_period = 7;
  keep_end(stopped, plan);
  CHECK_FALSE(stopped.verdict);
  CHECK(stopped.strobed.empty());
  CHECK(stopped.stopped_period == 7);
}

TEST_CASE("a class is claimed where the step resolves it") {
  const SectionPlan plan = plan_of_section();
  const double h = 2 * std::acos(-1.0) / (plan.pulsation * plan.steps_per_period);
  // Readings of 0.2 scales that alternate by a distance; impacts that rebound are placed to u of the scale.
  const auto alternating = [&](double distance, double u) {
    Orbit orbit = kept(1, same);
    for (std::size_t k = 0; k < orbit.strobed.size(); k += 2) orbit.readings.values[4 * k] += distance * plan.scale;
    orbit.rebounds = u * plan.scale / h;
    return orbit;
  };
  const double u = 1e-4, left_open = most_amplified * u;  // 0.005, below 5 % of 0.2
  const auto verdict = [&](double distance, double placed) {
    return judge(alternating(distance, placed), plan, std::nullopt).verdict;
  };
  CHECK(verdict(0.4 * left_open, u).motion == MotionClass{Regime::periodic, 1});
  CHECK(verdict(2.2 * left_open, u).motion == MotionClass{Regime::periodic, 2});
  for (const double between : {0.6, 1.9}) {
    CHECK(verdict(between * left_open, u).motion == MotionClass{Regime::undecided});
    CHECK(verdict(between * left_open, u).evidence.starts_with("not resolved by the step: readings 1 period apart"));
    CHECK(rough_class(alternating(between * left_open, u), plan) == MotionClass{Regime::undecided});
  }
  // Without impacts that rebound, what repeats is told to the last digit of the tolerance.
  CHECK(verdict(0.4 * left_open, 0).motion == MotionClass{Regime::periodic, 2});
  CHECK(orbit_period(alternating(0, u), plan).placed == Approx(u));
  // A section is open until the motion has forgotten what a placed impact displaced: 1/(1 − r) periods.
  const double period = 2 * std::acos(-1.0) / plan.pulsation;
  const auto open = [&](double rate) {
    return judge(alternating(0, u), plan, Interval{rate, rate, rate}).verdict.open;
  };
  CHECK(open(-std::log(2) / period) == Approx(2 * u));
  CHECK(open(-std::log(10) / period) == Approx(u / 0.9));
  CHECK(open(-1e-6 / period) == Approx(left_open));
  CHECK(verdict(0, u).open == Approx(left_open));
  CHECK(verdict(0, 0).open == 0);
  // However coarse the step, an orbit that differs by a twentieth of itself does not repeat.
  CHECK(orbit_period(alternating(0, 1), plan).tolerance <= 0.05 * 0.2 / 2 * 1.001);
}

}  // namespace judge_orbit_tests
