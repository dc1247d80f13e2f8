#include "runners/kinds/trajectory/energy_trend.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

// Steps of a problem that does not keep its energy: how the ratio moves between neighbours.
void tell_moves(const std::vector<double>& steps, const std::vector<double>& ratios, EnergyTrend& out) {
  const std::size_t n = ratios.size();
  const double last = *out.last_move;
  if (n < 3) {
    out.trend = Trend::pair;
    return;
  }
  const double before = std::abs(ratios[n - 2] - ratios[n - 3]);
  if (last < before && last > 0) out.order = std::log(before / last) / std::log(steps[n - 3] / steps[n - 2]);
  out.trend = last < 0.7 * before ? Trend::settles : last <= 1.4 * before ? Trend::keeps_moving : Trend::moves_further;
}

}  // namespace

const char* trend_word(Trend trend) {
  switch (trend) {
    case Trend::none:
      return "nothing finished";
    case Trend::single:
      return "one step only";
    case Trend::kept:
      return "kept";
    case Trend::reaches:
      return "reaches its start";
    case Trend::same:
      return "the same at every step";
    case Trend::settles:
      return "settles";
    case Trend::closer:
      return "comes closer";
    case Trend::gains:
      return "gains more";
    case Trend::loses:
      return "loses more";
    case Trend::unsteady:
      return "no steady trend";
    case Trend::pair:
      return "two steps only";
    case Trend::keeps_moving:
      return "keeps moving";
    case Trend::moves_further:
      return "moves more and more";
  }
  return "";
}

EnergyTrend energy_trend(const std::vector<double>& steps, const std::vector<double>& ratios, double noise,
                         bool conservative) {
  const std::size_t n = ratios.size();
  EnergyTrend out;
  if (n == 0) return out;
  out.ratio = ratios[n - 1];
  if (n > 1) out.last_move = std::abs(ratios[n - 1] - ratios[n - 2]);
  if (!conservative) {
    if (n == 1)
      out.trend = Trend::single;
    else
      tell_moves(steps, ratios, out);
    return out;
  }
  std::vector<double> change;
  for (const double r : ratios) change.push_back(std::abs(r - 1));
  const double largest = *std::max_element(change.begin(), change.end());
  const double smallest = *std::min_element(change.begin(), change.end());
  const double first = change.front(), last = change.back();
  out.first_change = first;
  out.last_change = last;
  out.smallest_change = smallest;
  out.largest_change = largest;
  if (largest <= noise) {
    out.trend = Trend::kept;
    return out;
  }
  if (n == 1) {
    out.trend = Trend::single;
    return out;
  }
  const double before = change[n - 2];
  if (last < before && last > noise) out.order = std::log(before / last) / std::log(steps[n - 2] / steps[n - 1]);
  bool falls = true, rises = true;
  for (std::size_t i = 1; i < n; ++i) {
    falls = falls && change[i] < change[i - 1];
    rises = rises && change[i] > change[i - 1];
  }
  if (last <= noise)
    out.trend = Trend::reaches;
  else if (largest <= 1.05 * smallest)
    out.trend = Trend::same;
  else if (*out.last_move <= 0.05 * last)
    out.trend = Trend::settles;
  else if (falls && last <= 0.8 * first)
    out.trend = Trend::closer;
  else if (rises && last >= 1.25 * first)
    out.trend = ratios[n - 1] > 1 ? Trend::gains : Trend::loses;
  else
    out.trend = Trend::unsteady;
  return out;
}

}  // namespace ricochet
