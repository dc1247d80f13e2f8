#include <algorithm>
#include <cmath>
#include <numeric>
#include <ricochet/measure/statistics/tiers.hpp>
#include <utility>

namespace ricochet {
namespace {

constexpr double share_of_spread = 0.3, wide = 2, decade_gap = 3, widest_tier = 10;

std::vector<Members> separated(Members members, const std::vector<LimitInterval>& intervals, double tolerance) {
  std::stable_sort(members.begin(), members.end(),
                   [&](std::size_t a, std::size_t b) { return intervals[a].low < intervals[b].low; });
  std::vector<Members> tiers;
  double top = 0;
  for (const std::size_t k : members) {
    if (tiers.empty() || intervals[k].low - top > tolerance) {
      tiers.push_back({k});
      top = intervals[k].high;
    } else {
      tiers.back().push_back(k);
      top = std::max(top, intervals[k].high);
    }
  }
  return tiers;
}

}  // namespace

Tiers tiers_of(const std::vector<Limit>& limits, double tolerance) {
  Tiers out;
  if (limits.empty()) return out;
  const auto [least, most] = std::minmax_element(limits.begin(), limits.end(),
                                                 [](const Limit& a, const Limit& b) { return a.value < b.value; });
  const double spread = most->value - least->value;
  std::vector<LimitInterval> intervals;
  Members firm, loose;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    intervals.push_back(interval(limits[k]));
    const double u = limits[k].uncertainty.value_or(0);
    (u > std::max(2 * tolerance, share_of_spread * spread) ? loose : firm).push_back(k);
  }
  if (firm.empty()) {
    out.none_firm = true;
    out.tiers = separated(loose, intervals, tolerance);
    return out;
  }
  out.tiers = separated(firm, intervals, tolerance);
  const std::vector<Members> of_firm = out.tiers;
  Members apart;  // loose ones away of every firm tier
  for (const std::size_t k : loose) {
    Members touched;
    for (std::size_t t = 0; t < of_firm.size(); ++t) {
      double low = intervals[of_firm[t].front()].low, high = intervals[of_firm[t].front()].high;
      for (const std::size_t member : of_firm[t]) {
        low = std::min(low, intervals[member].low);
        high = std::max(high, intervals[member].high);
      }
      if (low - tolerance <= intervals[k].high && high + tolerance >= intervals[k].low) touched.push_back(t);
    }
    if (touched.size() > 1 || *limits[k].uncertainty > wide * std::max(spread, tolerance))
      out.nowhere.push_back(k);
    else if (touched.size() == 1)
      out.tiers[touched.front()].push_back(k);
    else
      apart.push_back(k);
  }
  for (Members& tier : separated(apart, intervals, tolerance)) out.tiers.push_back(std::move(tier));
  const auto least_of = [&](const Members& tier) {
    double value = limits[tier.front()].value;
    for (const std::size_t k : tier) value = std::min(value, limits[k].value);
    return value;
  };
  std::stable_sort(out.tiers.begin(), out.tiers.end(),
                   [&](const Members& a, const Members& b) { return least_of(a) < least_of(b); });
  return out;
}

Tiers tiers_over_decades(const std::vector<double>& values, double nothing) {
  Tiers out;
  Members order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  double top = 0;
  for (const std::size_t k : order) {
    const double value = std::max(std::abs(values[k]), nothing);
    if (out.tiers.empty() || value > decade_gap * top) out.tiers.emplace_back();
    out.tiers.back().push_back(k);
    top = std::max(top, value);
  }
  const auto size = [&](std::size_t k) { return std::max(std::abs(values[k]), nothing); };
  for (std::size_t t = 0; t < out.tiers.size();) {
    const Members tier = out.tiers[t];
    if (size(tier.back()) <= widest_tier * size(tier.front())) {
      ++t;
      continue;
    }
    std::size_t cut = 1;
    for (std::size_t k = 1; k < tier.size(); ++k)
      if (size(tier[k]) * size(tier[cut - 1]) > size(tier[cut]) * size(tier[k - 1])) cut = k;
    const auto middle = tier.begin() + static_cast<std::ptrdiff_t>(cut);
    out.tiers[t] = Members(tier.begin(), middle);
    out.tiers.insert(out.tiers.begin() + static_cast<std::ptrdiff_t>(t) + 1, Members(middle, tier.end()));
  }
  return out;
}

}  // namespace ricochet
