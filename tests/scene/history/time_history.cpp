// Tables between their entries and beyond them, and motions integrated from accelerations.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/history/time_history.hpp>

#include "tests/refusals.hpp"

using namespace ricochet;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double pi = std::numbers::pi;

TimeTable triangle() {
  TimeTable table;
  table.name = "a.csv";
  table.times = {0, 0.025, 0.05};
  table.values = {0, 9.81, 0};
  return table;
}

}  // namespace

TEST_CASE("a table goes straight between entries, in steps, or as a spline") {
  TimeTable table = triangle();
  const PiecewiseCubic straight = PiecewiseCubic::interpolate(table);
  CHECK_THAT(straight.value(0.0125), WithinAbs(9.81 / 2, 1e-14));
  CHECK(straight.value(0.025) == 9.81);
  CHECK_THAT(straight.rate(0.03), WithinAbs(-9.81 / 0.025, 1e-10));
  table.between = TimeTable::Between::step;
  const PiecewiseCubic steps = PiecewiseCubic::interpolate(table);
  CHECK(steps.value(0.02499) == 0);
  CHECK(steps.value(0.025) == 9.81);
  CHECK(steps.value(0.0499) == 9.81);
}

TEST_CASE("a natural spline is off by 5/384 h⁴ max f'''' of a function without curvature at its ends") {
  TimeTable table;
  constexpr int pieces = 40;
  for (int i = 0; i <= pieces; ++i) {
    table.times.push_back(2 * pi * i / pieces);
    table.values.push_back(std::sin(table.times.back()));
  }
  table.between = TimeTable::Between::cubic;
  const PiecewiseCubic spline = PiecewiseCubic::interpolate(table);
  const double h = 2 * pi / pieces;
  for (double t = 0; t <= 2 * pi; t += 0.01) {
    CHECK_THAT(spline.value(t), WithinAbs(std::sin(t), 5.0 / 384 * std::pow(h, 4) * 1.01));
    CHECK_THAT(spline.rate(t), WithinAbs(std::cos(t), std::pow(h, 3) / 24 * 1.01));
    CHECK_THAT(spline.acceleration(t), WithinAbs(-std::sin(t), 3.0 / 8 * h * h));
  }
}

TEST_CASE("beyond its ends a table is zero or holds, as it says") {
  TimeTable table = triangle();
  table.times = {1, 2, 3};
  table.values = {4, 5, 6};
  using Beyond = TimeTable::Beyond;
  table.before = Beyond::zero;
  table.after = Beyond::hold;
  const PiecewiseCubic held = PiecewiseCubic::interpolate(table);
  CHECK(held.value(0.9) == 0);
  CHECK(held.value(3.5) == 6);
  CHECK(held.value(1e6) == 6);
  CHECK_FALSE(triangle().covers(0, 0.06, 1e-9));
  CHECK(triangle().covers(0, 0.05, 1e-9));
  CHECK(table.covers(0, 100, 0));
}

TEST_CASE("an acceleration in straight pieces is integrated exactly, from any state at t = 0") {
  TimeTable table = triangle();
  table.after = TimeTable::Beyond::zero;
  const PiecewiseCubic motion = PiecewiseCubic::integrate_twice(table, 0.5, -2);
  const double slope = 9.81 / 0.025;
  CHECK_THAT(motion.value(0), WithinAbs(0.5, 1e-15));
  CHECK_THAT(motion.rate(0), WithinAbs(-2, 1e-15));
  for (const double t : {0.004, 0.02, 0.025}) {
    CHECK_THAT(motion.acceleration(t), WithinAbs(t < 0.025 ? slope * t : 9.81, 1e-12));
    CHECK_THAT(motion.rate(t), WithinAbs(-2 + slope * t * t / 2, 1e-13));
    CHECK_THAT(motion.value(t), WithinAbs(0.5 - 2 * t + slope * t * t * t / 6, 1e-14));
  }
  // The pulse leaves the velocity of its area, and moves on.
  const double area = 9.81 * 0.025;
  CHECK_THAT(motion.rate(1), WithinAbs(-2 + area, 1e-13));
  CHECK_THAT(motion.value(1) - motion.value(0.5), WithinAbs(0.5 * (-2 + area), 1e-13));
  CHECK(motion.acceleration(1) == 0);
}

TEST_CASE("a speed in straight pieces or steps is integrated exactly, from its first instant on") {
  TimeTable table;
  table.times = {1, 2, 4};
  table.values = {4, 6, 2};
  table.before = table.after = TimeTable::Beyond::hold;
  const PiecewiseCubic way = PiecewiseCubic::interpolate(table).integral();
  for (const auto& [t, expected] :
       {std::pair(0.5, -2.0), {1.0, 0.0}, {2.0, 5.0}, {3.0, 10.0}, {4.0, 13.0}, {6.0, 17.0}})
    CHECK_THAT(way.value(t), WithinAbs(expected, 1e-14));
  for (const double t : {0.5, 1.5, 3.0, 5.0})
    CHECK_THAT(way.rate(t), WithinAbs(PiecewiseCubic::interpolate(table).value(t), 1e-14));
  table.between = TimeTable::Between::step;
  CHECK_THAT(PiecewiseCubic::interpolate(table).integral().value(3), WithinAbs(10, 1e-14));
}

TEST_CASE("a table that begins before t = 0 has the asked state at t = 0") {
  TimeTable table;
  table.times = {-1, 1};
  table.values = {3, 3};
  const PiecewiseCubic motion = PiecewiseCubic::integrate_twice(table, 2, 1);
  for (const double t : {-0.5, 0.0, 0.7}) CHECK_THAT(motion.value(t), WithinAbs(2 + t + 1.5 * t * t, 1e-14));
}

TEST_CASE("tables that are none are refused") {
  TimeTable table = triangle();
  table.times[2] = 0.02;
  CHECK_THROWS_WITH(table.check("/scene/load/0/force"), Catch::Contains("times must increase"));
  table.times = {0};
  table.values = {1};
  CHECK_THROWS_WITH(table.check(""), Catch::Contains("one entry; expected two"));
  table = triangle();
  table.values[1] = std::nan("");
  CHECK_THROWS_WITH(table.check(""), Catch::Contains("entry 2"));
}

namespace {

// cos(2π(t − 0.3)) at uneven instants of one period, from 0.1 s to 1.1 s.
TimeTable uneven_cosine(TimeTable::Between between) {
  TimeTable table;
  table.name = "cos.csv";
  for (int i = 0; i <= 60; ++i) {
    const double s = i / 60.0;
    table.times.push_back(0.1 + s + 0.004 * std::sin(2 * pi * 3 * s));
    table.values.push_back(std::cos(2 * pi * (table.times.back() - 0.3)));
  }
  table.values.back() = table.values.front();
  table.between = between;
  table.period = 1;
  return table;
}

}  // namespace

TEST_CASE("what repeats has the value, the slope and the curvature of one period before, and no kink at its ends") {
  const PiecewiseCubic spline = PiecewiseCubic::interpolate(uneven_cosine(TimeTable::Between::cubic));
  constexpr double longest = 1.3 / 60;  // between instants
  for (double t = -1.7; t < 2.5; t += 0.0173) {
    CHECK_THAT(spline.value(t), WithinAbs(std::cos(2 * pi * (t - 0.3)), 5.0 / 384 * std::pow(2 * pi * longest, 4)));
    CHECK_THAT(spline.value(t + 41), WithinAbs(spline.value(t), 1e-12));  // round-off of t over a slope of 2π
    CHECK_THAT(spline.acceleration(t), WithinAbs(-4 * pi * pi * std::cos(2 * pi * (t - 0.3)), 1));
  }
  constexpr double aside = 1e-9;  // the slope is 2π, f''' is 250: each moves by less than 1e-6 over that
  for (const double end : {0.1, 1.1}) {
    CHECK_THAT(spline.value(end - aside), WithinAbs(spline.value(end + aside), 1e-7));
    CHECK_THAT(spline.rate(end - aside), WithinAbs(spline.rate(end + aside), 1e-6));
    CHECK_THAT(spline.acceleration(end - aside), WithinAbs(spline.acceleration(end + aside), 1e-5));
  }
  // Three entries are two unknowns that are each other's neighbours twice.
  TimeTable few;
  few.times = {0, 1, 2};
  few.values = {0, 1, 0};
  few.between = TimeTable::Between::cubic;
  few.period = 2;
  const PiecewiseCubic wave = PiecewiseCubic::interpolate(few);
  CHECK_THAT(wave.rate(0), WithinAbs(0, 1e-14));
  CHECK_THAT(wave.acceleration(0), WithinAbs(6, 1e-12));
  CHECK_THAT(wave.acceleration(1), WithinAbs(-6, 1e-12));
}

TEST_CASE("an acceleration that repeats begins a motion that does, at the velocity and the place without a mean") {
  // A triangle wave, a(t + 1/2) = −a(t): so are φ' and φ. φ' rises by 1/4 in the middle half.
  TimeTable table;
  table.name = "a.csv";
  table.times = {0, 0.25, 0.75, 1};
  table.values = {0, 1, -1, 0};
  table.period = 1;
  const SteadyStart start = steady_start(table);
  CHECK_THAT(start.mean_acceleration, WithinAbs(0, 1e-16));
  CHECK_THAT(start.velocity, WithinAbs(-0.125, 1e-15));
  CHECK_THAT(start.position, WithinAbs(0, 1e-16));
  // The same wave as a table that begins elsewhere.
  TimeTable later = table;
  later.times = {0.25, 0.75, 1.25};
  later.values = {1, -1, 1};
  CHECK_THAT(steady_start(later).velocity, WithinAbs(-0.125, 1e-15));
  CHECK_THAT(steady_start(later).position, WithinAbs(0, 1e-15));
  for (const TimeTable& one : {table, later}) {
    const PiecewiseCubic motion = PiecewiseCubic::integrate_twice(one, 0.5, -0.125);
    for (const double t : {0.0, 0.1, 0.3, 0.6, 0.9}) {
      CHECK_THAT(motion.value(t + 7), WithinAbs(motion.value(t), 1e-14));
      CHECK_THAT(motion.value(t + 0.5) - 0.5, WithinAbs(0.5 - motion.value(t), 1e-14));
      CHECK_THAT(motion.rate(t + 0.5), WithinAbs(-motion.rate(t), 1e-14));
    }
    CHECK(motion.value(0) == 0.5);
  }
  table.values = {0, 1, -0.5, 0};
  CHECK_THAT(steady_start(table).mean_acceleration, WithinAbs(0.125 + 0.125 - 0.0625, 1e-15));
}

TEST_CASE("a table that repeats is as long as its period and ends as it begins") {
  TimeTable table = triangle();
  table.period = 0.05;
  CHECK_NOTHROW(table.check("/scene/motions/0/acceleration"));
  CHECK(table.covers(-3, 1e6, 0));
  const auto refusal = [](const TimeTable& of) { return testing::input_error([&] { of.check("/a"); }); };
  table.period = 0.06;
  CHECK(refusal(table) ==
        "/a/period: a.csv is 0.05 s long and is to repeat after 0.06 s; expected one period of it, 0.05 s");
  table.period = 0.05;
  table.values.back() = 0.1;
  CHECK(refusal(table) == "/a/period: a.csv begins with 0 and ends with 0.1; what repeats ends as it begins");
}

// Loads drawn from a spectrum: their power, their independence, their interpolation.

namespace {

SpectrumSpec flat(std::uint64_t seed) {
  SpectrumSpec spectrum;
  spectrum.density = [](double) { return 4.0; };
  spectrum.from = 1;
  spectrum.to = 50;
  spectrum.lines = 980;
  spectrum.seed = seed;
  spectrum.pointer = "/scene/load/0/force/psd";
  return spectrum;
}

}  // namespace

TEST_CASE("the mean square over 2/Δf is the area of the spectrum, whatever the seed") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RandomLoad load(flat(seed));
    CHECK(load.mean_square() == Approx(196).epsilon(1e-12));
    const double span = 2 * load.period();
    constexpr int samples = 1 << 17;
    double squares = 0, sum = 0;
    for (int i = 0; i < samples; ++i) {
      const double value = load.value(span * i / samples);
      squares += value * value;
      sum += value;
    }
    // The cubic is off by 2.5e-7 of the amplitude of each line.
    CHECK(std::sqrt(squares / samples) == Approx(14).epsilon(1e-6));
    CHECK(std::abs(sum / samples) < 1e-5);
  }
}

TEST_CASE("seeds and loads of other numbers are others, the same one is the same") {
  SpectrumSpec other = flat(1);
  other.load = 1;
  const RandomLoad one(flat(1)), again(flat(1)), seed(flat(2)), load(other);
  double with_seed = 0, with_load = 0;
  constexpr int samples = 4000;
  for (int i = 0; i < samples; ++i) {
    const double t = 0.01 * i, value = one.value(t);
    CHECK(value == again.value(t));
    with_seed += value * seed.value(t) / samples;
    with_load += value * load.value(t) / samples;
  }
  // Independent phases leave some 196/√980 of the product's mean.
  CHECK(std::abs(with_seed) < 40);
  CHECK(std::abs(with_load) < 40);
}

TEST_CASE("between instants a random load is the sum of its lines") {
  // One line: F = √(2 S Δf) cos(2π f t + θ) has a constant amplitude.
  SpectrumSpec spectrum = flat(5);
  spectrum.lines = 1;
  spectrum.from = 9.5;
  spectrum.to = 10.5;
  const RandomLoad load(spectrum);
  const double amplitude = std::sqrt(8.0), quarter = 1 / 40.0;
  for (double t = 0; t < 3; t += 0.0037)
    CHECK(std::hypot(load.value(t), load.value(t + quarter)) == Approx(amplitude).epsilon(1e-6));
}

TEST_CASE("a spectrum that is none is refused with its frequency") {
  SpectrumSpec spectrum = flat(1);
  spectrum.density = [](double f) { return 12 - f; };
  CHECK_THROWS_WITH(RandomLoad(spectrum), Catch::Contains("S(f) is -") && Catch::Contains("expected 0 or above"));
  spectrum = flat(1);
  spectrum.to = 0.5;
  CHECK_THROWS_WITH(RandomLoad(spectrum), Catch::Contains("ends at 0.5 Hz"));
}
