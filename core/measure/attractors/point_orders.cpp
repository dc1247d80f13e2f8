#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/attractors/match_points.hpp>
#include <ricochet/measure/motion/orders.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

constexpr double twice_both_widths = 4;  // of half widths
constexpr double widest_told = 0.5, least_told = 0.3, least_share = 0.02;
constexpr double first_order = 2;  // where the search for p begins

/// Between two sizes that follow each other.
struct Difference {
  double size = 0, ratio = 0;  ///< the coarser size, and how often the finer one goes into it
  double value = 0;            ///< finer − coarser
  double half = 0;             ///< of both intervals together
  bool counts() const { return std::abs(value) > twice_both_widths * half && value != 0; }
};

std::vector<PointLevel> coarse_to_fine(std::vector<PointLevel> levels) {
  for (const PointLevel& one : levels)
    if (!(one.size > 0) || !std::isfinite(one.size) || !(one.half >= 0))
      throw std::invalid_argument("a point needs positive sizes, and intervals that are not negative");
  std::stable_sort(levels.begin(), levels.end(),
                   [](const PointLevel& a, const PointLevel& b) { return a.size > b.size; });
  return levels;
}

std::vector<Difference> differences(const std::vector<PointLevel>& levels) {
  std::vector<Difference> out;
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const PointLevel &coarse = levels[k], &fine = levels[k + 1];
    out.push_back({coarse.size, coarse.size / fine.size, fine.value - coarse.value, coarse.half + fine.half});
  }
  return out;
}

/// Those that count, of one sign, in a row that ends with the finest one that counts.
std::vector<Difference> counted_run(const std::vector<Difference>& all) {
  std::size_t end = all.size();
  while (end > 0 && !all[end - 1].counts()) --end;
  std::size_t from = end;
  while (from > 0 && all[from - 1].counts() && all[from - 1].value * all[end - 1].value > 0) --from;
  return {all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// p of two differences, each changed by a share of itself.
std::optional<double> order_of_two(const Difference& first, const Difference& last, double share_first,
                                   double share_last) {
  const double h2 = first.size / first.ratio;
  return order_of(first.size, h2, h2 / last.ratio, first.value * (1 + share_first), last.value * (1 + share_last));
}

void solve_two(PointOrder& out, const Difference& first, const Difference& last) {
  const double a = std::max(least_share, first.half / std::abs(first.value)),
               b = std::max(least_share, last.half / std::abs(last.value));
  out.order = order_of_two(first, last, 0, 0);
  out.low = order_of_two(first, last, -a, b);
  out.high = order_of_two(first, last, a, -b);
}

std::string fit_many(PointOrder& out, const std::vector<Difference>& run) {
  double p = first_order;
  OrderFit fit;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    std::vector<OrderPoint> points;
    for (const Difference& one : run) {
      const double share = 1 - std::pow(one.ratio, -p);
      points.push_back({one.size, std::abs(one.value) / share, one.half / share});
    }
    fit = fit_order(points);
    if (!fit.order || *fit.order < least_told) break;
    const double before = p;
    p = *fit.order;
    if (std::abs(p - before) < 1e-13) break;
  }
  out.order = fit.order;
  out.low = fit.low;
  out.high = fit.high;
  out.used = fit.points > 0 ? fit.points + 1 : 0;
  return fit.order ? "" : fit.reason;
}

}  // namespace

PointOrder point_order(std::vector<PointLevel> levels) {
  levels = coarse_to_fine(std::move(levels));
  PointOrder out;
  if (levels.size() < 3) {
    out.reason = fmt::format("{} size{}, three are needed", levels.size(), levels.size() == 1 ? "" : "s");
    return out;
  }
  const std::vector<Difference> run = counted_run(differences(levels));
  out.used = run.empty() ? 0 : run.size() + 1;
  if (run.size() < 2) {
    out.reason = fmt::format("{} of {} differences are above their intervals and of one sign, two are needed",
                             run.size(), levels.size() - 1);
    return out;
  }
  std::string why;
  if (run.size() == 2)
    solve_two(out, run.front(), run.back());
  else
    why = fit_many(out, run);
  if (!out.order || !out.low || !out.high) {
    out.reason = why;
    return out;
  }
  const double half = 0.5 * (*out.high - *out.low);
  if (!(*out.low > least_told))
    out.reason = "the differences do not fall for certain";
  else if (half > widest_told)
    out.reason = fmt::format("the interval of ±{:.2g} is too wide", half);
  else
    out.told = true;
  if (out.told) out.reason = fmt::format("over {} of {} sizes", out.used, levels.size());
  return out;
}

PointLimit point_limit(std::vector<PointLevel> levels, const PointOrder& order) {
  if (levels.empty()) throw std::invalid_argument("a limit needs a level");
  levels = coarse_to_fine(std::move(levels));
  const PointLevel& finest = levels.back();
  std::vector<SizedValue> values;
  for (const PointLevel& one : levels) values.push_back({one.size, one.value});
  PointLimit out;
  out.value = finest.value;
  if (levels.size() == 1) return out;
  const PointLevel& before = levels[levels.size() - 2];
  const Limit plain = *limit_of(values, finest.half + before.half);
  out.status = plain.status;
  if (order.told) {
    out.correction = (finest.value - before.value) / (std::pow(before.size / finest.size, *order.order) - 1);
    out.value += out.correction;
    // One order alone may be chance: the first order's rest holds any that is larger.
    constexpr int several_orders = 4;
    out.open = order.used >= several_orders ? std::abs(out.correction)
                                            : std::abs(finest.value - before.value) / (before.size / finest.size - 1);
  } else if (plain.status == LimitStatus::same) {
    // What moves within the intervals is in them already.
    double largest = 0;
    for (std::size_t k = levels.size() > 3 ? levels.size() - 3 : 0; k + 1 < levels.size(); ++k)
      largest = std::max(largest, std::abs(levels[k + 1].value - levels[k].value));
    out.open = largest;
  } else if (const Limit moved = *limit_of(values, 0); moved.uncertainty && std::isfinite(*moved.uncertainty)) {
    out.open = *moved.uncertainty;
  }
  return out;
}

}  // namespace ricochet
