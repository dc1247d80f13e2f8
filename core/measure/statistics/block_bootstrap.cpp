#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <random>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <stdexcept>
#include <vector>

namespace ricochet {
namespace {

double mean_of(std::span<const double> series) {
  double sum = 0;
  for (const double x : series) sum += x;
  return sum / static_cast<double>(series.size());
}

double flat_top(double t) {
  return t <= 0.5 ? 1 : std::max(0.0, 2 * (1 - t));
}

/// What the correlogram says of a series.
struct Dependence {
  double block = 1;     // b
  double variance = 0;  // N times that of the mean: Σ λ R
};

Dependence dependence_of(std::span<const double> series) {
  const auto count = static_cast<int>(series.size());
  const double n = count, mean = mean_of(series);
  const double quiet = std::sqrt(std::log10(n) / n) * 2;
  const int run = std::max(5, static_cast<int>(std::sqrt(std::log10(n))));
  const int furthest = std::min(count - 1, static_cast<int>(std::ceil(std::sqrt(n))) + run);
  const auto covariance = [&](int lag) {
    double sum = 0;
    for (int i = 0; i + lag < count; ++i)
      sum += (series[static_cast<std::size_t>(i)] - mean) * (series[static_cast<std::size_t>(i + lag)] - mean);
    return sum / n;
  };
  std::vector<double> R;
  for (int lag = 0; lag <= furthest; ++lag) R.push_back(covariance(lag));
  if (!(R[0] > 0)) return {};
  // The lag after which `run` autocorrelations in a row are no more than chance; none: the last that is more.
  int last = 0, calm = 0, cut = -1;
  for (int lag = 1; lag <= furthest && cut < 0; ++lag) {
    if (std::abs(R[static_cast<std::size_t>(lag)]) < quiet * R[0]) {
      if (++calm == run) cut = lag - run;
    } else {
      calm = 0;
      last = lag;
    }
  }
  const int window = std::min(furthest, 2 * std::max(1, cut >= 0 ? cut : last));
  double G = 0, g = R[0];
  for (int lag = 1; lag <= window; ++lag) {
    const double term = 2 * flat_top(static_cast<double>(lag) / window) * R[static_cast<std::size_t>(lag)];
    G += lag * term;
    g += term;
  }
  const double longest = std::max(1.0, std::min(3 * std::sqrt(n), n / 3));
  if (g == 0) return {longest, 0};
  return {std::clamp(std::cbrt(G * G / (g * g) * n), 1.0, longest), g};
}

}  // namespace

double bootstrap_block_length(std::span<const double> series) {
  return dependence_of(series).block;
}

Interval block_bootstrap_mean(std::span<const double> series, double confidence, int resamples, std::uint64_t seed) {
  if (series.size() < fewest_resampled) throw std::invalid_argument("a bootstrap needs 8 readings or more");
  if (!(confidence > 0 && confidence < 1)) throw std::invalid_argument("a confidence lies between 0 and 1");
  for (const double x : series)
    if (!std::isfinite(x)) throw std::invalid_argument("a bootstrap needs finite readings");
  const std::size_t count = series.size();
  const double n = static_cast<double>(count), mean = mean_of(series);
  const auto [block, variance] = dependence_of(series);
  // Sums from the start, over two rounds of the circle.
  std::vector<double> sums(2 * count + 1);
  for (std::size_t i = 0; i < 2 * count; ++i) sums[i + 1] = sums[i] + (series[i % count] - mean);

  std::mt19937_64 random(seed);
  const double stop = block > 1 ? std::log1p(-1 / block) : 0;
  const auto length = [&](std::size_t left) -> std::size_t {
    if (stop == 0) return 1;
    const double unit = (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
    const double drawn = 1 + std::floor(std::log(unit) / stop);
    return drawn < static_cast<double>(left) ? static_cast<std::size_t>(drawn) : left;
  };
  std::vector<double> means(static_cast<std::size_t>(std::max(resamples, 2)));
  double resampled = 0;
  for (double& one : means) {
    double sum = 0;
    for (std::size_t left = count; left > 0;) {
      const std::size_t taken = length(left), from = static_cast<std::size_t>(random() % count);
      sum += sums[from + taken] - sums[from];
      left -= taken;
    }
    one = sum / n;
    resampled += one * one / static_cast<double>(means.size());
  }
  std::sort(means.begin(), means.end());
  const double tail = 0.5 * (1 - confidence);
  double open = boost::math::quantile(boost::math::students_t(std::max(1.0, n / block - 1)), 1 - tail) /
                boost::math::quantile(boost::math::normal(), 1 - tail);
  if (resampled > 0 && variance > n * resampled) open *= std::sqrt(variance / (n * resampled));
  return {mean, mean + open * std::min(0.0, quantile(means, tail)),
          mean + open * std::max(0.0, quantile(means, 1 - tail))};
}

}  // namespace ricochet
