// Spectra: the integral of a density is the variance, and its place is the frequency.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <ricochet/measure/statistics/welch.hpp>

using namespace ricochet;

namespace {

constexpr double pi = std::numbers::pi;

double integral(const WelchSpectrum& spectrum) {
  const std::vector<double> density = spectrum.density();
  return std::accumulate(density.begin(), density.end(), 0.0) * spectrum.spacing();
}

}  // namespace

TEST_CASE("a sine on a frequency of the transform: half its squared amplitude, whatever its mean and phase") {
  constexpr double rate = 256, amplitude = 3;
  constexpr int size = 128, wave = 10;
  WelchSpectrum spectrum(rate, size);
  for (int n = 0; n < 5 * size; ++n) spectrum.add(7 + amplitude * std::sin(2 * pi * wave * n / size + 0.3));
  CHECK(spectrum.segments() == 9);
  CHECK(integral(spectrum) == Approx(amplitude * amplitude / 2).epsilon(1e-12));
  const std::vector<double> density = spectrum.density();
  REQUIRE(density.size() == size / 2 + 1);
  const auto top = std::max_element(density.begin(), density.end()) - density.begin();
  CHECK(spectrum.frequency(static_cast<int>(top)) == rate * wave / size);
  // A Hann window spreads a line over three frequencies, 2/3 of it in the middle.
  CHECK(density[wave] * spectrum.spacing() == Approx(amplitude * amplitude / 3).epsilon(1e-12));
  CHECK(density[wave + 2] * spectrum.spacing() == Approx(0).margin(1e-20));
}

TEST_CASE("independent numbers have a flat density, whose integral is their variance") {
  constexpr double rate = 1000, deviation = 2;
  constexpr int size = 256, segments = 2000;
  WelchSpectrum spectrum(rate, size);
  RunningMoments moments;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> numbers(1, deviation);
  for (int n = 0; n < segments * size / 2; ++n) {
    const double x = numbers(generator);
    spectrum.add(x);
    moments.add(x);
  }
  // Deviations of a mean over 2000 half-overlapping segments: 2 % a frequency, 0.3 % the integral; the mean of each
  // segment takes one of 256 degrees of freedom.
  CHECK(integral(spectrum) == Approx(std::pow(moments.deviation(), 2)).epsilon(0.015));
  const std::vector<double> density = spectrum.density();
  for (int k = 4; k < size / 2 - 2; ++k)
    CHECK(density[static_cast<std::size_t>(k)] == Approx(2 * deviation * deviation / rate).epsilon(0.15));
}

TEST_CASE("what is no spectrum is refused, and a signal shorter than a segment has none") {
  CHECK_THROWS_AS(WelchSpectrum(0, 8), std::invalid_argument);
  CHECK_THROWS_AS(WelchSpectrum(1, 7), std::invalid_argument);
  CHECK_THROWS_AS(WelchSpectrum(1, 2), std::invalid_argument);
  WelchSpectrum spectrum(1, 8);
  for (int n = 0; n < 7; ++n) spectrum.add(n);
  CHECK(spectrum.density().empty());
  spectrum.add(7);
  CHECK(spectrum.segments() == 1);
}

TEST_CASE("moments of parts add up to those of all, and a window puts every time into one of its parts") {
  RunningMoments all, left, right;
  for (int n = 0; n < 50; ++n) {
    const double x = 1e6 + std::sin(n * n);
    all.add(x, 1 + n % 3);
    (n < 20 ? left : right).add(x, 1 + n % 3);
  }
  left.add(right);
  CHECK(left.weight == all.weight);
  CHECK(left.mean == Approx(all.mean).epsilon(1e-15));
  CHECK(left.deviation() == Approx(all.deviation()).epsilon(1e-9));
  CHECK(left.least == all.least);
  CHECK(left.rms() == Approx(std::hypot(all.mean, all.deviation())).epsilon(1e-15));

  const WindowParts window{1, 3, 4};
  CHECK(window.of(1, 0) == -1);
  CHECK(window.of(1.1, 0) == 0);
  CHECK(window.of(1.5, 1e-9) == 0);
  CHECK(window.of(1.5 + 1e-6, 1e-9) == 1);
  CHECK(window.of(3, 0) == 3);
  CHECK(window.of(3 + 1e-10, 1e-9) == 3);
  CHECK(window.of(3.1, 1e-9) == -1);
}
