#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <ricochet/measure/orbits/zero_one_test.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

constexpr std::size_t fewest_readings = 60, frequencies = 100, longest_lag = 100;
constexpr double no_variation = 1e-12;  // of a series that does not vary

// Correlation of (1, …, m) with D.
double correlation(const std::vector<double>& D) {
  const double n = static_cast<double>(D.size()), middle = 0.5 * (n - 1);
  double mean = 0, both = 0, squares = 0;
  for (const double d : D) mean += d / n;
  for (std::size_t i = 0; i < D.size(); ++i) {
    both += (static_cast<double>(i) - middle) * (D[i] - mean);
    squares += (D[i] - mean) * (D[i] - mean);
  }
  if (squares == 0) return 0;
  return both / std::sqrt(squares * n * (n * n - 1) / 12);
}

}  // namespace

std::optional<double> zero_one_test(std::span<const double> series, std::uint64_t seed) {
  const std::size_t count = series.size();
  if (count < fewest_readings) return std::nullopt;
  double mean = 0, largest = 0, spread = 0;
  for (const double x : series) {
    if (!std::isfinite(x)) return std::nullopt;
    mean += x / static_cast<double>(count);
    largest = std::max(largest, std::abs(x));
  }
  for (const double x : series) spread = std::max(spread, std::abs(x - mean));
  if (!std::isfinite(mean)) return std::nullopt;
  if (spread <= no_variation * largest) return 0.0;

  std::mt19937_64 random(seed);
  const std::size_t lags = std::min(count / 10, longest_lag), from = count - lags;
  std::vector<double> p(count + 1), q(count + 1), D(lags), K(frequencies);
  for (double& k : K) {
    const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
    const double c = std::numbers::pi * (0.2 + 0.6 * unit);
    for (std::size_t j = 0; j < count; ++j) {
      const double phi = (series[j] - mean) / spread, angle = c * static_cast<double>(j + 1);
      p[j + 1] = p[j] + phi * std::cos(angle);
      q[j + 1] = q[j] + phi * std::sin(angle);
    }
    for (std::size_t n = 1; n <= lags; ++n) {
      double sum = 0;
      for (std::size_t j = 0; j < from; ++j) {
        const double dp = p[j + n] - p[j], dq = q[j + n] - q[j];
        sum += dp * dp + dq * dq;
      }
      D[n - 1] = sum / static_cast<double>(from);
    }
    k = correlation(D);
  }
  return median(std::move(K));
}

}  // namespace ricochet
