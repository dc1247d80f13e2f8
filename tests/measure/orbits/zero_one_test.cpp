// The 0–1 test on maps of which one knows what they do.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <ricochet/measure/orbits/zero_one_test.hpp>
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
  // θ ← θ + Ω − k/(2π) sin 2πθ: quasi-periodic for small k and the golden Ω, chaotic at k = 6 for this Ω (its
  // exponent, Σ ln|1 − k cos 2πθ|/N, is checked to be clearly of its sign).
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
