// The class of an orbit: maps of which one knows it, from their own series; then each rule by itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <ricochet/measure/orbits/judge_orbit.hpp>
#include <ricochet/measure/orbits/regime.hpp>

using namespace ricochet;

namespace regime_tests {

namespace {

constexpr double tolerance = 1e-6;

/// A map of one variable with its local exponents, shown as `reading`.
struct Map {
  std::function<double(double)> next, slope, reading = [](double x) { return x; };
};

Map logistic(double r) {
  return {[r](double x) { return r * x * (1 - x); }, [r](double x) { return r * (1 - 2 * x); }};
}

Map circle(double omega, double k) {
  const double turn = 2 * std::numbers::pi;
  return {[=](double x) { return x + omega - k / turn * std::sin(turn * x); },
          [=](double x) { return 1 - k * std::cos(turn * x); }, [=](double x) { return std::cos(turn * x + 0.5); }};
}

enum class With { exponent, no_exponent };

RegimeInput observed(const Map& map, With with, int kept = 400) {
  double x = 0.31;
  for (int k = 0; k < 2000; ++k) x = map.next(x);
  SectionSeries series{1, {}};
  std::vector<double> local;
  for (int k = 0; k < kept; ++k) {
    series.values.push_back(map.reading(x));
    local.push_back(std::log(std::abs(map.slope(x))));
    x = map.next(x);
  }
  RegimeInput input;
  input.contact = true;
  input.recurrence = find_recurrence(series, {1.0}, tolerance);
  if (with == With::exponent) input.exponent = block_bootstrap_mean(local);
  input.zero_one = zero_one_test(series.values);
  input.impacts_per_period = 2;
  input.tolerance = tolerance;
  return input;
}

RegimeInput touched(Recurrence recurrence = {0, 0.3, 1, 300}) {
  RegimeInput input;
  input.contact = true;
  input.recurrence = recurrence;
  input.impacts_per_period = 2.5;
  input.tolerance = tolerance;
  return input;
}

const Recurrence third{3, 2e-9, 1, 300};

bool says(const RegimeVerdict& verdict, const std::string& words) {
  return verdict.evidence.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("regime: the logistic and circle maps are what they are known to be, with and without an exponent") {
  for (const With with : {With::exponent, With::no_exponent}) {
    INFO((with == With::exponent ? "with an exponent" : "without"));
    for (const auto& [r, period] : std::vector<std::pair<double, int>>{{3.2, 2}, {3.5, 4}, {3.83, 3}, {3.55, 8}}) {
      const RegimeVerdict verdict = classify(observed(logistic(r), with));
      INFO("r = " << r << ": " << verdict.evidence);
      CHECK(verdict.motion.regime == Regime::periodic);
      CHECK(verdict.period == period);
    }
    for (const double r : {3.7, 3.9, 4.0}) {
      const RegimeVerdict verdict = classify(observed(logistic(r), with));
      INFO("r = " << r << ": " << verdict.evidence);
      CHECK(verdict.motion.regime == Regime::chaotic);
      CHECK(verdict.period == 0);
    }
    // Below k = 1 the circle map is invertible: the golden rotation does not lock at k = 0.3.
    const RegimeVerdict golden = classify(observed(circle(std::numbers::phi - 1, 0.3), with));
    INFO(golden.evidence);
    CHECK(golden.motion.regime == Regime::quasi_periodic);
    // Ω = ½ locks to period 2.
    const RegimeVerdict locked = classify(observed(circle(0.5, 0.9), with));
    INFO(locked.evidence);
    CHECK(locked.motion.regime == Regime::periodic);
    CHECK(locked.period == 2);
  }
}

TEST_CASE("regime: the exponents of the logistic map lie where they are known to") {
  // ln 2 at r = 4; negative on cycles.
  const RegimeInput chaotic = observed(logistic(4), With::exponent, 2000);
  CHECK(chaotic.exponent->low < std::numbers::ln2);
  CHECK(chaotic.exponent->high > std::numbers::ln2);
  CHECK(observed(logistic(3.2), With::exponent).exponent->high < 0);
}

TEST_CASE("regime: without contact nothing else matters") {
  RegimeInput input = touched();
  input.contact = false;
  input.exponent = Interval{1, 0.9, 1.1};
  input.zero_one = 0.99;
  CHECK(classify(input).motion.regime == Regime::no_contact);
  CHECK(classify(input).period == 0);
  input.recurrence = {1, 1e-10, 1, 300};
  CHECK(classify(input).period == 1);
  CHECK(says(classify(input), "no stop was touched"));
}

TEST_CASE("regime: a superstable orbit that is not seen to repeat has a longer period, whatever K says") {
  constexpr double least = -std::numeric_limits<double>::infinity();
  RegimeInput input = touched(third);
  input.exponent = Interval{least, least, least};
  input.zero_one = 0.99;
  CHECK(classify(input).motion == MotionClass{Regime::periodic, 3});
  CHECK(says(classify(input), "superstable"));
  input.recurrence = touched().recurrence;
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "superstable"));
  CHECK(says(classify(input), "the period may exceed the longest looked for"));
}

TEST_CASE("regime: a contact that never opens is rest, whatever repeats") {
  RegimeInput input = touched(third);
  input.rests = true;
  input.impacts_per_period = 0;
  CHECK(classify(input).motion == MotionClass{Regime::at_rest});
  CHECK(classify(input).period == 3);
  CHECK(says(classify(input), "the contact with the stop never opened"));
  input.recurrence = {0, 0.3, 1, 300};
  CHECK(classify(input).motion == MotionClass{Regime::at_rest});
  input.contact = false;
  CHECK(classify(input).motion == MotionClass{Regime::no_contact});
}

TEST_CASE("regime: what repeats is periodic unless an exponent above zero contradicts") {
  RegimeInput input = touched(third);
  CHECK(classify(input).motion.regime == Regime::periodic);
  CHECK(classify(input).period == 3);
  CHECK(says(classify(input), "repeats every 3 forcing periods within 2e-09 over 300 periods, 2.5 impacts per period"));
  input.zero_one = 0.95;  // K of a series of round-off tells nothing
  CHECK(classify(input).motion.regime == Regime::periodic);
  input.exponent = Interval{-0.1, -0.2, -0.05};
  CHECK(classify(input).motion.regime == Regime::periodic);
  input.exponent = Interval{0.0, -0.01, 0.01};
  CHECK(classify(input).motion.regime == Regime::periodic);
  input.exponent = Interval{0.5, 0.4, 0.6};
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "contradictory"));
  // 0.4 1/s over 300 periods of 1 s is e^120; over periods of 1 ms it is 1.13 and shows nowhere.
  input.forcing_period = 1;
  CHECK(classify(input).motion.regime == Regime::undecided);
  input.forcing_period = 1e-3;
  CHECK(classify(input).motion.regime == Regime::periodic);
  // An orbit that is still arriving says so.
  const RegimeVerdict arriving = classify(touched({2, 3e-4, 0.97, 300}));
  CHECK(arriving.motion.regime == Regime::periodic);
  CHECK(says(arriving, "settles every 2 forcing periods"));
}

TEST_CASE("regime: exponents decide what does not repeat, the 0–1 test where there is none") {
  RegimeInput input = touched();
  input.zero_one = 0.1;
  input.exponent = Interval{0.5, 0.4, 0.6};
  CHECK(classify(input).motion.regime == Regime::chaotic);
  input.exponent = Interval{0.0, -0.01, 0.01};
  CHECK(classify(input).motion.regime == Regime::quasi_periodic);
  // Zero lies in the interval of what still approaches an orbit that repeats, too.
  const Recurrence apart = input.recurrence;
  input.recurrence = {0, 1e-3, 0.99, 300};
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "still settling"));
  input.recurrence = apart;
  input.zero_one = 0.5;
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "K = 0.50"));
  input.zero_one.reset();
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "60 kept periods"));
  input.exponent = Interval{-0.2, -0.3, -0.1};
  for (const double K : {0.05, 0.95}) {
    input.zero_one = K;
    CHECK(classify(input).motion.regime == Regime::undecided);
    CHECK(says(classify(input), "neighbours approach each other"));
  }
  input.exponent.reset();
  CHECK(classify(input).motion.regime == Regime::chaotic);
  input.zero_one = 0.79;
  CHECK(classify(input).motion.regime == Regime::undecided);
  input.zero_one = 0.19;
  CHECK(classify(input).motion.regime == Regime::quasi_periodic);
  // Distances that halve over the window belong to an orbit that is being approached.
  input.recurrence = {0, 1e-3, 0.99, 300};
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "still settling"));
  input.recurrence = {};
  CHECK(classify(input).motion.regime == Regime::undecided);
  CHECK(says(classify(input), "too few periods"));
}

TEST_CASE("regime: an exponent that shear explains makes no chaos of what is regular or still approaches") {
  // Neighbours on tori part in proportion to time: 300-fold over 300 periods, e^5.7.
  const double sheared = std::log(300.0) / 300;
  const auto judged = [&](double low, double K, double shrunk) {
    RegimeInput input = touched();
    input.forcing_period = 2;
    input.exponent = Interval{low / 2 + 0.01, low / 2, low / 2 + 0.02};
    input.zero_one = K;
    input.shrunk = shrunk;
    return classify(input);
  };
  for (const double growth : {0.2, 0.9, 1.1, 20.0}) {
    INFO(growth << " times what shear explains");
    const double low = growth * sheared;
    CHECK(judged(low, 0.9, 1).motion.regime == Regime::chaotic);
    CHECK(judged(low, 0.5, 1).motion.regime == Regime::chaotic);
    const Regime doubted = growth > 1 ? Regime::chaotic : Regime::undecided;
    CHECK(judged(low, 0.1, 1).motion.regime == doubted);
    CHECK(judged(low, 0.9, 0.8).motion.regime == doubted);
    if (growth > 1) continue;
    CHECK(says(judged(low, 0.1, 1), "K = 0.10 is regular: neighbours of a regular orbit part as far in 300 periods"));
    CHECK(says(judged(low, 0.9, 0.8), "ranges shrink from third to third of the window, to 0.8: neighbours"));
  }
  // A growth below 2 over the window is no sign above zero, as round-off of a conserved area is none.
  for (const double low : {1e-17, 0.9 * std::numbers::ln2 / 300}) {
    CHECK(judged(low, 0.1, 1).motion.regime == Regime::quasi_periodic);
    CHECK(judged(low, 0.9, 1).motion.regime == Regime::undecided);
  }
}

TEST_CASE("regime: ranges that shrink belong to an orbit that is being approached, with and without an exponent") {
  RegimeInput input = touched();
  for (const bool exponent : {true, false})
    for (const double K : {0.1, 0.9}) {
      INFO((exponent ? "with an exponent, K = " : "without, K = ") << K);
      input.exponent.reset();
      if (exponent) input.exponent = Interval{0.0, -0.01, 0.01};
      input.zero_one = K;
      input.shrunk = 1;
      const Regime kept = K < 0.5 ? Regime::quasi_periodic : exponent ? Regime::undecided : Regime::chaotic;
      CHECK(classify(input).motion.regime == kept);
      input.shrunk = 0.97;
      CHECK(classify(input).motion.regime == Regime::undecided);
      if (kept != Regime::undecided)
        CHECK(says(classify(input), "ranges shrink from third to third of the window, to 0.97: still settling"));
    }
  // What repeats does, whatever its ranges.
  input.recurrence = third;
  CHECK(classify(input).motion == MotionClass{Regime::periodic, 3});
}

TEST_CASE("regime: a transient cut at its cap is told") {
  RegimeInput input = touched(third);
  CHECK_FALSE(says(classify(input), "cap"));
  input.settled = false;
  CHECK(says(classify(input), "the transient was cut at its cap"));
}

}  // namespace regime_tests
