// Spectra: the integral of a density is the variance, and its place is the frequency.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <ricochet/measure/statistics/running_moments.hpp>
#include <ricochet/measure/statistics/spectra.hpp>

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
  // Deviations of a mean over 2000 half-overlapping segments: 2 % a frequency, 0.3 % the integral. The mean of each
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

// Levels of thirds of octaves: what bands are, and that no power is lost or told twice.

TEST_CASE("thirds of octaves have the names of the standard, and ten of them are a decade") {
  const std::vector<ThirdOctave> bands = third_octaves(std::vector<double>(20001, 1.0), 0.1);
  REQUIRE(bands.size() > 20);
  for (std::size_t i = 1; i < bands.size(); ++i) CHECK(bands[i].from == Approx(bands[i - 1].to).epsilon(1e-14));
  const auto named = [&](const std::string& name) {
    const auto found =
        std::find_if(bands.begin(), bands.end(), [&](const ThirdOctave& one) { return one.nominal() == name; });
    REQUIRE(found != bands.end());
    return *found;
  };
  for (const char* name : {"1", "1.25", "31.5", "63", "100", "125", "1000", "1600"}) named(name);
  CHECK(named("63").centre() == Approx(63.0957344480193).epsilon(1e-14));
  CHECK(named("100").from == Approx(89.1250938133746).epsilon(1e-14));
  // The widths of bands below 0.4 Hz are less than a line's 0.1 Hz, and 2000 Hz ends above the last line.
  CHECK(bands.front().to - bands.front().from >= 0.1);
  CHECK(bands.back().to <= 2000);
}

TEST_CASE("a band of white noise has its width, and bands beside each other lose nothing") {
  // Lines of 1.7 Hz end nowhere near the ends of bands.
  const std::vector<ThirdOctave> bands = third_octaves(std::vector<double>(2000, 4.0), 1.7);
  double sum = 0;
  for (const ThirdOctave& band : bands) {
    CHECK(band.rms * band.rms == Approx(4 * (band.to - band.from)).epsilon(1e-12));
    sum += band.rms * band.rms;
  }
  CHECK(sum == Approx(4 * (bands.back().to - bands.front().from)).epsilon(1e-12));
}

TEST_CASE("a line has its power in the band that it lies in, and in no other") {
  std::vector<double> density(1001, 0.0);
  density[200] = 9.0 / 0.5;  // 100 Hz, rms 3
  for (const ThirdOctave& band : third_octaves(density, 0.5))
    CHECK(band.rms == Approx(band.nominal() == "100" ? 3.0 : 0.0).margin(1e-12));
}

TEST_CASE("a density without lines has no bands") {
  CHECK(third_octaves({}, 1).empty());
  CHECK(third_octaves({1.0}, 1).empty());
}
