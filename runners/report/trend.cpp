#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/answer.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {

double noise_of(const CaseRecord& record) {
  const double round_off = 0x1p-52 * static_cast<double>(record.steps);
  const auto residual = CaseView::measure(record, "balance_residual"),
             start = CaseView::measure(record, "energy_start");
  return residual && start && *start > 0 ? std::max(round_off, std::abs(*residual) / *start) : round_off;
}

namespace {

/// Steps of a problem that does not keep its energy: how the ratio moves between neighbours.
Trend moving_trend(const std::vector<double>& steps, const std::vector<double>& ratios) {
  const size_t n = ratios.size();
  const double last = std::abs(ratios[n - 1] - ratios[n - 2]), scale = std::abs(ratios[n - 1]);
  Trend out;
  const std::string finest = percent_text(ratios[n - 1]), moved = number_text(last / scale, 2);
  if (n < 3) {
    out.words = fmt::format("{}; the two steps differ by {} of it", finest, moved);
    return out;
  }
  const double before = std::abs(ratios[n - 2] - ratios[n - 3]);
  if (last < before && last > 0) out.order = std::log(before / last) / std::log(steps[n - 3] / steps[n - 2]);
  const char* how = last < 0.7 * before ? "settles" : last <= 1.4 * before ? "keeps moving" : "moves more and more";
  out.words = fmt::format("{}: {} at the finest step, last move {} of it", how, finest, moved);
  return out;
}

}  // namespace

Trend step_trend(const std::vector<double>& steps, const std::vector<double>& ratios, double noise, bool conservative) {
  const size_t n = ratios.size();
  if (n == 0) return {"no finished case", {}};
  if (n == 1 && !conservative) return {"one step only", {}};
  if (!conservative) return moving_trend(steps, ratios);
  std::vector<double> change;
  for (const double r : ratios) change.push_back(std::abs(r - 1));
  const double largest = *std::max_element(change.begin(), change.end());
  const double smallest = *std::min_element(change.begin(), change.end());
  if (largest <= noise) return {n == 1 ? "kept to the noise floor" : "kept to the noise floor at every step", {}};
  if (n == 1) return {"one step only", {}};

  const double first = change[0], before = change[n - 2], last = change[n - 1];
  const double last_move = std::abs(ratios[n - 1] - ratios[n - 2]);
  Trend out;
  if (last < before && last > noise) out.order = std::log(before / last) / std::log(steps[n - 2] / steps[n - 1]);
  bool falls = true, rises = true;
  for (size_t i = 1; i < n; ++i) {
    falls = falls && change[i] < change[i - 1];
    rises = rises && change[i] > change[i - 1];
  }
  const std::string from_to = fmt::format("|change| {} → {}", number_text(first, 2), number_text(last, 2));
  if (last <= noise)
    out.words = "reaches its start within the noise floor";
  else if (largest <= 1.05 * smallest)
    out.words = "the same change at every step, to 5 %";
  else if (last_move <= 0.05 * last)
    out.words = fmt::format("settles near {}: the two finest steps differ by {}", percent_text(ratios[n - 1]),
                            number_text(last_move, 2));
  else if (falls && last <= 0.8 * first)
    out.words = "comes closer to its start: " + from_to;
  else if (rises && last >= 1.25 * first)
    out.words = (ratios[n - 1] > 1 ? "gains more as the step shrinks: " : "loses more as the step shrinks: ") + from_to;
  else
    out.words =
        fmt::format("no steady trend: |change| between {} and {}", number_text(smallest, 2), number_text(largest, 2));
  return out;
}

}  // namespace ricochet::report
