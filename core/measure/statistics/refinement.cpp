#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ricochet/measure/statistics/refinement.hpp>

namespace ricochet {
namespace {

// Of what is left by an order that three sizes show (Roache, 1994).
constexpr double safety = 1.25;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double orders_agree = 0.6, steepest_order = 4.5;
constexpr double grows = 1.5, grown = 3, growth_exponent = -0.3;
constexpr double falls = 0.35, width = 0.6;

/// Orders of |e| between sizes that follow each other; nothing where one is zero.
std::optional<double> slope(const SizedValue& coarse, const SizedValue& fine) {
  if (coarse.value == 0 || fine.value == 0) return std::nullopt;
  return std::log(std::abs(coarse.value / fine.value)) / std::log(coarse.size / fine.size);
}

Limit at_finest(const std::vector<SizedValue>& values) {
  Limit out;
  out.sizes = values.size();
  if (out.sizes > 1) out.ratio = values[out.sizes - 2].size / values.back().size;
  out.value = out.low = out.high = values.back().value;
  const std::size_t first = values.size() > 3 ? values.size() - 3 : 0;
  double low = out.value, high = out.value;
  for (std::size_t k = first; k < values.size(); ++k) {
    low = std::min(low, values[k].value);
    high = std::max(high, values[k].value);
  }
  out.range = high - low;
  return out;
}

void set(Limit& limit, LimitStatus status, double uncertainty) {
  limit.status = status;
  limit.uncertainty = uncertainty;
  limit.low = limit.value - uncertainty;
  limit.high = limit.value + uncertainty;
}

/// The last three values, and their last two differences.
struct Tail {
  SizedValue v1, v2, v3;
  double before, last;

  double lowest() const { return std::min({v1.value, v2.value, v3.value}); }
  double highest() const { return std::max({v1.value, v2.value, v3.value}); }
  std::optional<double> order() const { return order_of(v1.size, v2.size, v3.size, before, last); }
  /// What an order leaves after the last difference, times a factor.
  double rest(double order, double factor = 1) const {
    return factor * std::abs(last) / (std::pow(v2.size / v3.size, order) - 1);
  }
  /// What first order leaves of the difference before the last, times a factor.
  double first_order_rest(double factor) const { return factor * std::abs(before) * v3.size / (v1.size - v2.size); }
};

/// To zero, in the order that its sizes show.
std::optional<Limit> vanishing(const Tail& t, Limit out, double floor) {
  if (std::abs(t.v3.value) > std::abs(t.last) ||
      std::min({std::abs(t.v1.value), std::abs(t.v2.value), std::abs(t.v3.value)}) <= floor)
    return std::nullopt;
  const auto before = slope(t.v1, t.v2), now = slope(t.v2, t.v3);
  // What passes zero on its way to a limit beyond falls as well, and has more left than itself.
  constexpr double beyond = 1.5;
  const auto order = t.order();
  const double rest = order && *order > 0 ? t.rest(*order) : 0;
  if (!before || !now || std::min(*before, *now) < lowest_order || rest > beyond * std::abs(t.v3.value))
    return std::nullopt;
  out.status = LimitStatus::vanishes;
  out.uncertainty = std::max(std::abs(out.value), safety * rest);
  out.low = std::min(0.0, out.value);
  out.high = std::max(0.0, out.value);
  out.order = now;
  return out;
}

/// By an order that three sizes show; two orders that agree are needed for less than the last difference. One that
/// turned, or fell more steeply than schemes do, is small by chance; any may be where the error has a saw tooth.
Limit settling(const Tail& t, const std::vector<SizedValue>& values, const std::vector<double>& d, double order,
               Limit out, double floor, Errors errors) {
  const double last = std::abs(t.last);
  double u = std::max(safety * last, t.rest(order, safety));
  if (t.before * t.last < 0 || order > steepest_order || errors == Errors::saw_toothed)
    u = std::max(u, t.first_order_rest(safety));
  if (errors == Errors::saw_toothed) {
    u = std::max(u, out.range);
    // Three teeth may fall together by chance: what coarser sizes were off by falls with the size at least.
    for (const SizedValue& one : values)
      u = std::max(u, safety * std::abs(one.value - out.value) * values.back().size / one.size);
  }
  // Orders of saw teeth agree by chance too.
  if (const std::size_t n = values.size();
      errors == Errors::smooth && n >= 4 && t.before * t.last > 0 && d[n - 4] * t.before > 0) {
    const auto earlier = order_of(values[n - 4].size, t.v1.size, t.v2.size, d[n - 4], t.before);
    if (earlier && std::abs(order - *earlier) <= orders_agree && order <= steepest_order) {
      out.order = order;
      // An order that still changes may fall as much again.
      const double low = std::max(lowest_order, order - std::abs(order - *earlier));
      u = std::max(0.1 * last, t.rest(low, safety));
    }
  }
  set(out, LimitStatus::settles, std::max(u, floor));
  return out;
}

/// As the last sizes tell it, without a truth.
Limit by_last_sizes(const std::vector<SizedValue>& values, double floor, Errors errors) {
  Limit out = at_finest(values);
  const std::size_t n = values.size();
  if (n == 1) return out;
  std::vector<double> d;
  for (std::size_t k = 1; k < n; ++k) d.push_back(values[k].value - values[k - 1].value);
  const double last = std::abs(d.back());
  if (std::all_of(d.begin(), d.end(), [&](double move) { return std::abs(move) <= floor; })) {
    set(out, LimitStatus::same, floor);
    return out;
  }
  if (n == 2) {
    set(out, LimitStatus::two, std::max(last, floor));
    return out;
  }
  const Tail t{values[n - 3], values[n - 2], values[n - 1], d[n - 3], d[n - 2]};
  if (const auto limit = vanishing(t, out, floor)) return *limit;
  // What grows as a power of the size; differences that only do not shrink may still add up to a limit.
  const auto exponent = t.order();
  if (std::abs(t.v2.value) > grows * std::abs(t.v1.value) && std::abs(t.v3.value) > grows * std::abs(t.v2.value) &&
      std::abs(t.v3.value) > grown * std::abs(values.front().value) && exponent && *exponent <= growth_exponent) {
    out.status = LimitStatus::blows_up;
    out.uncertainty = infinity;
    out.low = t.lowest();
    out.high = t.highest();
    return out;
  }
  if (last <= floor) {
    set(out, LimitStatus::settles, errors == Errors::saw_toothed ? std::max(floor, out.range) : floor);
    return out;
  }
  if (const auto order = t.order(); order && *order >= lowest_order)
    return settling(t, values, d, *order, std::move(out), floor, errors);
  if (t.before * t.last > 0 && (n < 5 || d[n - 4] * t.before > 0)) {
    out.status = LimitStatus::moves;
    out.uncertainty = 2 * last;
    out.trend = t.last > 0 ? 1 : -1;
    const double end = out.value + 2 * t.last;
    out.low = std::min(out.value, end);
    out.high = std::max(out.value, end);
    return out;
  }
  out.status = LimitStatus::wanders;
  out.uncertainty = out.range;
  out.low = t.lowest();
  out.high = t.highest();
  return out;
}

/// By how much later values lie beyond what three coarser sizes, or more, told as settled; 0 where they hold them all.
double missed(const std::vector<SizedValue>& values, double floor, Errors errors) {
  constexpr std::size_t fewest = 3;
  double most = 0;
  for (std::size_t m = fewest; m < values.size(); ++m) {
    const Limit told = by_last_sizes({values.begin(), values.begin() + static_cast<std::ptrdiff_t>(m)}, floor, errors);
    if (told.status != LimitStatus::settles) continue;
    for (std::size_t k = m; k < values.size(); ++k)
      if (const double off = std::abs(values[k].value - told.value); off > *told.uncertainty)
        most = std::max(most, off);
  }
  return most;
}

/// Without a truth. Where no order is confirmed, the coarser sizes show how far such an interval may be off.
Limit plain_limit(const std::vector<SizedValue>& values, double floor, Errors errors) {
  Limit out = by_last_sizes(values, floor, errors);
  if (out.status == LimitStatus::settles && !out.order)
    set(out, out.status, std::max(*out.uncertainty, missed(values, floor, errors)));
  return out;
}

}  // namespace

bool Limit::settled() const {
  return status == LimitStatus::same || status == LimitStatus::settles || status == LimitStatus::reaches_truth ||
         status == LimitStatus::vanishes;
}

std::optional<double> order_of(double h1, double h2, double h3, double d1, double d2) {
  if (d1 == 0) return std::nullopt;
  const double ratio = std::abs(d2 / d1);
  constexpr double tiny = 1e-9;
  const auto of = [&](double p) {
    if (std::abs(p) < tiny) return std::log(h2 / h3) / std::log(h1 / h2);
    return (std::pow(h2, p) - std::pow(h3, p)) / (std::pow(h1, p) - std::pow(h2, p));
  };
  double low = -3, high = 8;
  if (ratio > of(low)) return low;
  if (ratio < of(high)) return high;
  constexpr int halvings = 60;
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (low + high);
    (of(middle) > ratio ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<Limit> limit_of(std::vector<SizedValue> values, double floor, std::optional<double> truth,
                              Errors errors) {
  if (values.empty()) return std::nullopt;
  std::stable_sort(values.begin(), values.end(),
                   [](const SizedValue& a, const SizedValue& b) { return a.size > b.size; });
  Limit out = plain_limit(values, floor, errors);
  if (!truth || values.size() < 2) return out;
  std::vector<SizedValue> off = values;
  for (SizedValue& one : off) one.value -= *truth;
  const double left = std::abs(off.back().value);
  const auto reached = [&](double uncertainty, std::optional<double> order) {
    out.status = LimitStatus::reaches_truth;
    out.uncertainty = uncertainty;
    out.low = std::min(out.value, *truth);
    out.high = std::max(out.value, *truth);
    out.order = order;
    out.trend = 0;
  };
  if (left <= floor) {
    reached(floor, std::nullopt);
    return out;
  }
  if (values.size() < 3) return out;
  const std::size_t n = off.size();
  const auto before = slope(off[n - 3], off[n - 2]), now = slope(off[n - 2], off[n - 1]);
  if (before && now && std::min(*before, *now) >= lowest_order) reached(left, now);
  return out;
}

std::optional<Limit> combined(const std::optional<Limit>& step, const std::optional<Limit>& mesh) {
  if (!step) return mesh;
  if (!mesh || mesh->status == LimitStatus::one) return step;
  if (step->status == LimitStatus::one) return mesh;
  Limit out = *step;
  // Statuses stand in the order from firm to restless; of a mesh alone a truth or zero is no limit.
  const bool worse = static_cast<int>(mesh->status) > static_cast<int>(step->status);
  if (mesh->restless() && (!step->restless() || worse)) {
    out.status = mesh->status;
    out.trend = mesh->trend;
    out.order.reset();
  } else if (mesh->status == LimitStatus::blows_up) {
    out.status = mesh->status;
  } else if (step->status == LimitStatus::two && mesh->settled()) {
    out.status = LimitStatus::settles;
  } else if (step->status == LimitStatus::same) {
    out.status = mesh->status == LimitStatus::same  ? LimitStatus::same
                 : mesh->status == LimitStatus::two ? LimitStatus::settles
                                                    : mesh->status;
    out.order = mesh->order;
  }
  out.uncertainty = *step->uncertainty + *mesh->uncertainty;
  out.low = step->low + mesh->low - mesh->value;
  out.high = step->high + mesh->high - mesh->value;
  out.range = std::max(step->range, mesh->range);
  return out;
}

void bound_growth(Limit& limit, double most) {
  if (limit.status != LimitStatus::blows_up || std::abs(limit.value) > most) return;
  limit.status = LimitStatus::moves;
  limit.uncertainty = 2 * limit.range;
  limit.trend = limit.value > 0 ? 1 : -1;
  const double end = limit.value + 2 * limit.trend * limit.range;
  limit.low = std::min(limit.value, end);
  limit.high = std::max(limit.value, end);
}

void widen(Limit& limit, double half) {
  if (!limit.uncertainty) return;
  *limit.uncertainty += half;
  limit.low -= half;
  limit.high += half;
}

void doubt_chance(std::vector<Limit*> limits) {
  const auto restless = std::count_if(limits.begin(), limits.end(), [](const Limit* one) { return one->restless(); });
  if (2 * static_cast<std::size_t>(restless) <= limits.size()) return;
  for (Limit* one : limits)
    if (one->status == LimitStatus::settles && !one->order && one->sizes == 3)
      set(*one, LimitStatus::moves, std::max(*one->uncertainty, one->range));
}

LimitInterval interval(const Limit& limit) {
  if (limit.status == LimitStatus::wanders) {
    const double half = 0.5 * limit.uncertainty.value_or(0);
    return {limit.low - half, limit.high + half};
  }
  return {std::min(limit.low, limit.value), std::max(limit.high, limit.value)};
}

bool OrderRun::clean() const {
  constexpr double narrow = 0.15, wide = 0.3;  // shares of the order
  if (verdict != Verdict::order || in_passing || beyond.size() > 1) return false;
  std::size_t falling = 0, rising = 0, like = 0;
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const bool inside = k >= first && k < first + length;
    falling += slopes[k] >= falls;
    rising += slopes[k] <= -falls;
    like += inside || (slopes[k] >= falls && std::abs(slopes[k] - order) <= width);
  }
  if (length == 2 && order > steepest_of_two) return false;
  if (length == 2) return like == falling && rising == 0 && most - least <= narrow * order;
  const auto begin = slopes.begin() + static_cast<std::ptrdiff_t>(first),
             end = begin + static_cast<std::ptrdiff_t>(length);
  const bool flattens = std::is_sorted(begin, end, std::greater<>()) && most - least > wide * order;
  return 2 * like >= falling + rising && !flattens;
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
  constexpr double floors = 3, least_slope = 0.4;
  std::vector<SizedValue> points;
  for (const SizedValue& one : errors)
    if (one.value > floors * floor && one.value > 0) points.push_back(one);
  if (points.size() < 3) {
    out.verdict = points.size() < 2 && errors.size() >= 3 ? OrderRun::Verdict::below_floor : OrderRun::Verdict::too_few;
    return out;
  }
  std::vector<double>& slopes = out.slopes;
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
    out.first = from;
    out.length = length;
    const SizedValue &first = points[from], &last = points[from + length];
    out.order = std::log(first.value / last.value) / std::log(first.size / last.size);
    const auto begin = slopes.begin() + static_cast<std::ptrdiff_t>(from);
    const auto [least, most] = std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(length));
    constexpr double flatter = 0.8;  // on the way to a level that is reached each slope is well below the one before it
    for (std::size_t k = from + length; k < slopes.size(); ++k)
      if (slopes[k] >= falls && std::abs(slopes[k] - out.order) > width &&
          !(stays && slopes[k] < flatter * slopes[k - 1]))
        out.beyond.push_back(slopes[k]);
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
