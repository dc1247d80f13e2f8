// Loads drawn from a spectrum: their power, their independence, their interpolation.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/history/time_history.hpp>

using namespace ricochet;

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
