#include <algorithm>
#include <cmath>
#include <ricochet/measure/statistics/order_run.hpp>

namespace ricochet {

const char* word(OrderRun::Verdict verdict) {
  switch (verdict) {
    case OrderRun::Verdict::order:
      return "order";
    case OrderRun::Verdict::stops:
      return "stops";
    case OrderRun::Verdict::does_not_fall:
      return "does not fall";
    case OrderRun::Verdict::no_steady_order:
      return "no steady order";
    case OrderRun::Verdict::below_floor:
      return "at the floor";
    case OrderRun::Verdict::too_few:
      return "too few";
  }
  return "";
}

std::optional<OrderRun> order_run(std::vector<SizedValue> errors, double floor) {
  if (errors.empty()) return std::nullopt;
  std::stable_sort(errors.begin(), errors.end(),
                   [](const SizedValue& a, const SizedValue& b) { return a.size > b.size; });
  OrderRun out;
  out.last = errors.back().value;
  out.last_size = errors.back().size;
  out.smallest = out.last;
  for (const SizedValue& one : errors) out.smallest = std::min(out.smallest, one.value);
  constexpr double floors = 3, falls = 0.35, least_slope = 0.4, width = 0.6;
  std::vector<SizedValue> points;
  for (const SizedValue& one : errors)
    if (one.value > floors * floor && one.value > 0) points.push_back(one);
  if (points.size() < 3) {
    out.verdict = points.size() < 2 && errors.size() >= 3 ? OrderRun::Verdict::below_floor : OrderRun::Verdict::too_few;
    return out;
  }
  std::vector<double> slopes;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    slopes.push_back(std::log(points[k].value / points[k + 1].value) / std::log(points[k].size / points[k + 1].size));
  std::size_t from = 0, length = 0;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    double least = slopes[i], most = slopes[i];
    for (std::size_t j = i; j < slopes.size(); ++j) {
      least = std::min(least, slopes[j]);
      most = std::max(most, slopes[j]);
      if (least < least_slope || most - least > width) break;
      // Of equally long runs the finest.
      if (j > i && j + 1 - i >= length) from = i, length = j + 1 - i;
    }
  }
  const bool stays = slopes.back() < falls;
  if (length >= 2) {
    out.verdict = OrderRun::Verdict::order;
    const SizedValue &first = points[from], &last = points[from + length];
    out.order = std::log(first.value / last.value) / std::log(first.size / last.size);
    const auto begin = slopes.begin() + static_cast<std::ptrdiff_t>(from);
    const auto [least, most] = std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(length));
    out.least = *least;
    out.most = *most;
    out.from = first.size;
    out.to = last.size;
    out.in_passing = length == 2 && from + length < slopes.size() && 2 * length <= slopes.size();
    if (from + length < slopes.size() && stays) out.stops_at = out.smallest;
    return out;
  }
  if (*std::max_element(slopes.begin(), slopes.end()) < falls)
    out.verdict = OrderRun::Verdict::does_not_fall;
  else
    out.verdict = stays ? OrderRun::Verdict::stops : OrderRun::Verdict::no_steady_order;
  if (out.verdict != OrderRun::Verdict::no_steady_order) out.stops_at = out.smallest;
  return out;
}

double order_class(double order) {
  struct Class {
    double order, low, high;
  };
  constexpr Class classes[] = {{0.5, 0.4, 0.7}, {1, 0.7, 1.4}, {1.5, 1.4, 1.6},
                               {2, 1.6, 2.6},   {3, 2.6, 3.4}, {4, 3.4, 4.7}};
  for (const Class& one : classes)
    if (order >= one.low && order < one.high) return one.order;
  return std::round(order);
}

}  // namespace ricochet
