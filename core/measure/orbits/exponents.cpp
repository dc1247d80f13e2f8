#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/lyapunov.hpp>

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

// Whether the summed difference of two series stays within twice what it swings about its own trend. That of a pair is
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

constexpr double twin_offset = 1e-7;  // m

bool usable(const std::vector<double>& rates) {
  return !rates.empty() && std::all_of(rates.begin(), rates.end(), [](double rate) { return std::isfinite(rate); });
}

// More than one period in a hundred: the mean is a lower bound.
bool saturates(const LyapunovRates& twin) {
  return 100 * twin.saturated > static_cast<int>(twin.rates[0].size());
}

// What tangent columns say of an orbit. A column beyond what the state can tell apart has no growth to speak of.
OrbitExponents by_tangents(const LyapunovRates& found, int count, int columns) {
  OrbitExponents exponents;
  if (found.end) return exponents;
  exponents.superstable = columns > 0 && found.told == 0;
  exponents.untold = !exponents.superstable && found.untold > 0;
  if (exponents.superstable) exponents.method = "superstable";
  if (exponents.superstable || exponents.untold) return exponents;
  const auto& all = found.rates;
  const auto last = std::find_if_not(all.begin(), all.begin() + found.told, usable);
  exponents.values = exponent_intervals({all.begin(), last}, count, found.turning);
  exponents.method = found.jumps > 0 ? "tangent+jump" : "tangent";
  return exponents;
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

std::vector<OrbitExponents> exponents_of(const std::function<Program(int columns)>& program,
                                         const std::vector<LaneState>& states, LyapunovPlan plan, int count,
                                         int columns) {
  std::vector<OrbitExponents> found(states.size());
  std::vector<LyapunovRates> rates;
  bool tangents = true;
  plan.keep_orbit = !plan.without_sawtooth;
  try {
    rates = lyapunov_rates(program(columns), states, plan);
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = by_tangents(rates[i], count, columns);
  } catch (const Refusal&) {
    tangents = false;
    plan.keep_orbit = true;
    rates = lyapunov_rates(program(0), states, plan);
  }
  if (!plan.keep_orbit) return found;
  const std::vector<LyapunovRates> twin = twin_rates(program(0), states, rates, plan, twin_offset);
  for (std::size_t i = 0; i < found.size(); ++i) {
    OrbitExponents& exponents = found[i];
    if (exponents.superstable || rates[i].jumps > 0 || twin[i].end || !usable(twin[i].rates[0])) continue;
    if (saturates(twin[i])) {
      exponents.saturated = !tangents;
      continue;
    }
    exponents.twin = exponent_interval(twin[i].rates[0]);
    if (tangents) continue;
    exponents.values = {*exponents.twin};
    exponents.method = fmt::format("twin({:g})", twin_offset);
  }
  return found;
}

}  // namespace ricochet
