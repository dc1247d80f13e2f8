#include <algorithm>
#include <ricochet/measure/orbits/exponent_intervals.hpp>

namespace ricochet {
namespace {

constexpr double steadier = 0.05;    // variance of the area's growth over that of one column
constexpr double turns_above = 0.5;  // share of the rounds

// Variance of the sum of two series.
double spread(const std::vector<double>& a, const std::vector<double>& b) {
  double mean = 0, sum = 0;
  const auto count = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) mean += (a[i] + b[i]) / count;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] + b[i] - mean) * (a[i] + b[i] - mean) / count;
  return sum;
}

// Whether the summed difference of two series stays within twice what it swings about its own trend: that of a pair is
// bounded, that of two real multipliers grows.
bool stays_together(const std::vector<double>& a, const std::vector<double>& b) {
  double end = 0;
  for (std::size_t i = 0; i < a.size(); ++i) end += a[i] - b[i];
  double sum = 0, low = 0, high = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a[i] - b[i];
    const double off = sum - end * static_cast<double>(i + 1) / static_cast<double>(a.size());
    low = std::min(low, off);
    high = std::max(high, off);
  }
  return std::abs(end) <= 2 * (high - low);
}

}  // namespace

Interval exponent_interval(const std::vector<double>& rates) {
  if (rates.size() >= static_cast<std::size_t>(fewest_resampled)) return block_bootstrap_mean(rates);
  double mean = 0;
  for (const double rate : rates) mean += rate / static_cast<double>(rates.size());
  return {mean, mean, mean};
}

std::vector<Interval> exponent_intervals(const std::vector<std::vector<double>>& rates, int count,
                                         const std::vector<double>& turning) {
  std::vector<Interval> found;
  for (std::size_t k = 0; k < rates.size() && static_cast<int>(found.size()) < count; ++k) {
    if (k + 1 < rates.size()) {
      const double alone = spread(rates[k], std::vector<double>(rates[k].size(), 0.0));
      const auto count_of = static_cast<double>(rates[k].size());
      double apart = 0;
      for (std::size_t i = 0; i < rates[k].size(); ++i) apart += (rates[k][i] - rates[k + 1][i]) / count_of;
      // Two real multipliers stay apart; the means of a pair's columns agree up to their swing.
      const bool together = apart * apart <= 16 * alone / count_of;
      const bool turns =
          k < turning.size() ? turning[k] > turns_above : turning.empty() && stays_together(rates[k], rates[k + 1]);
      if (together && turns && spread(rates[k], rates[k + 1]) < steadier * alone) {
        std::vector<double> half(rates[k].size());
        for (std::size_t i = 0; i < half.size(); ++i) half[i] = 0.5 * (rates[k][i] + rates[k + 1][i]);
        found.insert(found.end(), 2, exponent_interval(half));
        ++k;
        continue;
      }
    }
    found.push_back(exponent_interval(rates[k]));
  }
  found.resize(std::min(found.size(), static_cast<std::size_t>(count)));
  return found;
}

}  // namespace ricochet
