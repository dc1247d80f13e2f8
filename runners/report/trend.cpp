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

Trend step_trend(const std::vector<double>& steps, const std::vector<double>& ratios, double noise) {
  const size_t n = ratios.size();
  if (n == 0) return {"no finished case", {}};
  std::vector<double> change;
  for (const double r : ratios) change.push_back(std::abs(r - 1));
  const double largest = *std::max_element(change.begin(), change.end()),
               smallest = *std::min_element(change.begin(), change.end());
  if (largest <= noise) return {n == 1 ? "kept to round-off" : "kept to round-off at every step", {}};
  if (n == 1) return {"one step only", {}};

  const double last = change[n - 1], before = change[n - 2], first = change[0];
  const double last_move = std::abs(ratios[n - 1] - ratios[n - 2]);
  Trend out;
  if (last < before && last > noise) out.order = std::log(before / last) / std::log(steps[n - 2] / steps[n - 1]);
  bool falls = true, rises = true;
  for (size_t i = 1; i < n; ++i) {
    falls = falls && change[i] < change[i - 1];
    rises = rises && change[i] > change[i - 1];
  }
  if (last <= noise)
    out.words = "reaches its start within round-off";
  else if (largest <= 1.05 * smallest)
    out.words = "the same change at every step, to 5 %";
  else if (last_move <= 0.05 * last)
    out.words = fmt::format("settles near {}: the two finest steps differ by {}", percent_text(ratios[n - 1]),
                            number_text(last_move, 2));
  else if (falls && last <= 0.7 * first)
    out.words = fmt::format("comes closer to its start: |change| {} → {}", number_text(first, 2), number_text(last, 2));
  else if (rises && last >= 1.4 * first)
    out.words = fmt::format("{} more as the step shrinks: |change| {} → {}", ratios[n - 1] > 1 ? "gains" : "loses",
                            number_text(first, 2), number_text(last, 2));
  else
    out.words =
        fmt::format("no steady trend: |change| between {} and {}", number_text(smallest, 2), number_text(largest, 2));
  return out;
}

}  // namespace ricochet::report
