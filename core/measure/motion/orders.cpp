#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <ricochet/measure/motion/orders.hpp>
#include <stdexcept>

namespace ricochet {
namespace {

constexpr double above_floor = 4;                          // e over what it is measured against, to count
constexpr double dip_depth = 4;                            // under its neighbours' interpolation
constexpr double largest_scatter = 0.4;                    // of ln e: a factor of 1.5
constexpr double slope_change = 0.1;                       // from end to end, that does not matter
constexpr double end_miss = 0.05;                          // of ln e at an end, that does not matter
constexpr double falling = 0.3;                            // slope below which errors do not fall
constexpr double trust = 0.02;                             // relative, of any error
constexpr double chance_bend = 0.975, chance_end = 0.995;  // two-sided 95 % and 99 %
constexpr double widest = 0.5, widest_near = 0.3, near = 0.05, margin = 0.1;
constexpr std::size_t fewest_faster = 5;

double student(double p, std::size_t freedom) {
  return boost::math::quantile(boost::math::students_t(static_cast<double>(freedom)), p);
}

/// ln r and ln e of the usable points, coarse to fine.
struct Logs {
  std::vector<double> x, y, trust;
  std::vector<std::size_t> index;  ///< into the points given
  std::size_t size() const { return x.size(); }
  void erase(std::size_t k) {
    const auto at = static_cast<std::ptrdiff_t>(k);
    x.erase(x.begin() + at), y.erase(y.begin() + at), trust.erase(trust.begin() + at), index.erase(index.begin() + at);
  }
};

/// Points [from, to).
struct Window {
  std::size_t from = 0, to = 0;
  std::size_t count() const { return to - from; }
};

struct Line {
  double slope = 0, mean_x = 0, mean_y = 0, sxx = 0;
  double squares = 0;  ///< Σ residual²
  std::size_t count = 0;
  double at(double x) const { return mean_y + slope * (x - mean_x); }
  double scatter() const { return std::sqrt(squares / static_cast<double>(count - 2)); }
};

Line line_through(const Logs& logs, const Window& w) {
  Line line;
  line.count = w.count();
  const double n = static_cast<double>(w.count());
  for (std::size_t k = w.from; k < w.to; ++k) line.mean_x += logs.x[k] / n, line.mean_y += logs.y[k] / n;
  double sxy = 0;
  for (std::size_t k = w.from; k < w.to; ++k) {
    const double dx = logs.x[k] - line.mean_x;
    line.sxx += dx * dx;
    sxy += dx * (logs.y[k] - line.mean_y);
  }
  line.slope = sxy / line.sxx;
  for (std::size_t k = w.from; k < w.to; ++k) line.squares += std::pow(logs.y[k] - line.at(logs.x[k]), 2);
  return line;
}

/// Whether the slopes from point to point only rise, or only fall: +1, −1 towards the fine end; 0 neither.
int drift(const Logs& logs, const Window& w) {
  int sign = 0;
  double last = 0;
  for (std::size_t k = w.from; k + 1 < w.to; ++k) {
    const double slope = (logs.y[k + 1] - logs.y[k]) / (logs.x[k + 1] - logs.x[k]);
    const int change = k == w.from ? 0 : slope > last ? 1 : slope < last ? -1 : 0;
    if (k > w.from && (change == 0 || (sign != 0 && change != sign))) return 0;
    sign = change;
    last = slope;
  }
  return sign;
}

/// Change of slope from end to end by a quadratic term, and whether it is more than chance.
struct Bend {
  double change = 0;
  bool significant = false, steady = false;
};

Bend bend_of(const Logs& logs, const Window& w, const Line& line) {
  if (w.count() < 4) return {};
  // The quadratic made orthogonal to the line: u = (x − mean)² − its own line.
  double third = 0;
  for (std::size_t k = w.from; k < w.to; ++k) third += std::pow(logs.x[k] - line.mean_x, 3);
  const double mean_square = line.sxx / static_cast<double>(w.count()), tilt = third / line.sxx;
  double uu = 0, uy = 0;
  for (std::size_t k = w.from; k < w.to; ++k) {
    const double dx = logs.x[k] - line.mean_x, u = dx * dx - tilt * dx - mean_square;
    uu += u * u;
    uy += u * (logs.y[k] - line.at(logs.x[k]));
  }
  const double coefficient = uy / uu, left = std::max(0.0, line.squares - coefficient * uy);
  const double error = std::sqrt(left / static_cast<double>(w.count() - 3) / uu);
  const bool steady = drift(logs, w) != 0;
  return {2 * coefficient * (logs.x[w.to - 1] - logs.x[w.from]),
          (steady && w.count() >= 6) || std::abs(coefficient) > student(chance_bend, w.count() - 3) * error, steady};
}

/// Whether the others predict the point `end`.
bool predicted(const Logs& logs, const Window& others, std::size_t end) {
  const Line line = line_through(logs, others);
  const double dx = logs.x[end] - line.mean_x;
  const double reach = line.scatter() * std::sqrt(1 + 1 / static_cast<double>(others.count()) + dx * dx / line.sxx);
  return std::abs(logs.y[end] - line.at(logs.x[end])) <=
         std::max(end_miss, student(chance_end, others.count() - 2) * reach);
}

bool straight(const Logs& logs, const Window& w) {
  const Line line = line_through(logs, w);
  if (line.scatter() > largest_scatter) return false;
  if (w.count() < 4) return true;
  const Bend bend = bend_of(logs, w, line);
  if (bend.significant && std::abs(bend.change) > slope_change) return false;
  return predicted(logs, {w.from + 1, w.to}, w.from) && predicted(logs, {w.from, w.to - 1}, w.to - 1);
}

/// A line and half of the 95 % interval of its slope.
struct Fit {
  Window window;
  Line line;
  double half = 0;
  double slope() const { return line.slope; }
  bool falls() const { return line.slope - half > falling; }
};

Fit fit(const Logs& logs, const Window& w) {
  Fit out{w, line_through(logs, w), 0};
  double correlation = 0;
  if (w.count() >= 5 && out.line.squares > 0) {
    const auto residual = [&](std::size_t k) { return logs.y[k] - out.line.at(logs.x[k]); };
    for (std::size_t k = w.from; k + 1 < w.to; ++k) correlation += residual(k) * residual(k + 1) / out.line.squares;
    correlation = std::clamp(correlation, 0.0, 0.8);
  }
  const double spread = out.line.scatter() / std::sqrt(out.line.sxx);
  out.half = student(0.975, w.count() - 2) * spread * std::sqrt((1 + correlation) / (1 - correlation));
  for (std::size_t k = w.from; k < w.to; ++k)
    out.half += std::abs(logs.x[k] - out.line.mean_x) / out.line.sxx * logs.trust[k];
  const Bend bend = bend_of(logs, w, out.line);
  if (bend.significant || bend.steady) out.half += 0.5 * std::abs(bend.change);
  return out;
}

/// The longest straight window of [from, to) that `accept` takes, the finer of equals.
template <class Accept>
std::optional<Fit> longest(const Logs& logs, std::size_t from, std::size_t to, Accept accept) {
  for (std::size_t count = to - from; count >= 3 && to >= from + 3; --count)
    for (std::size_t end = to; end >= from + count; --end) {
      const Window w{end - count, end};
      if (!straight(logs, w)) continue;
      const Fit candidate = fit(logs, w);
      if (accept(candidate)) return candidate;
    }
  return std::nullopt;
}

/// What is usable, merged and without dips; `dips` gets the indices of those.
Logs usable(const std::vector<OrderPoint>& points, const OrderQuestion& question, std::vector<std::size_t>& dips) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const OrderPoint& p = points[k];
    if (!(p.size > 0) || !std::isfinite(p.size) || p.error < 0 || p.floor < 0)
      throw std::invalid_argument("an order needs positive sizes, and errors and floors that are not negative");
    const double against = std::max(std::isfinite(p.floor) ? p.floor : HUGE_VAL, question.other_error);
    if (std::isfinite(p.error) && p.error > above_floor * against) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].size > points[b].size; });
  Logs logs;
  for (std::size_t at = 0; at < order.size();) {
    std::size_t end = at;
    double y = 0, known = trust;
    for (; end < order.size() && points[order[end]].size == points[order[at]].size; ++end) {
      const OrderPoint& p = points[order[end]];
      y += std::log(p.error);
      known = std::max(known, -std::log1p(-(p.floor + question.other_error) / p.error));
    }
    logs.x.push_back(std::log(points[order[at]].size));
    logs.y.push_back(y / static_cast<double>(end - at));
    logs.trust.push_back(known);
    logs.index.push_back(order[at]);
    at = end;
  }
  const std::size_t allowed = logs.size() / 5;
  for (std::size_t k = 1; k + 1 < logs.size() && dips.size() < allowed; ++k) {
    const double run = logs.x[k + 1] - logs.x[k - 1], rise = logs.y[k + 1] - logs.y[k - 1];
    const double between = logs.y[k - 1] + rise * (logs.x[k] - logs.x[k - 1]) / run;
    if (logs.y[k] > between - std::log(dip_depth) || logs.y[k + 1] <= logs.y[k] || rise / run < falling) continue;
    dips.push_back(logs.index[k]);
    logs.erase(k);
  }
  return logs;
}

std::string span_text(const std::vector<OrderPoint>& points, const OrderFit& fitted, const OrderQuestion& question) {
  std::string out = fmt::format("{} of {} points, {} {:.3g} to {:.3g}", fitted.points, points.size(), question.refined,
                                points[fitted.first].size, points[fitted.last].size);
  if (!fitted.left_out.empty())
    out += fmt::format(" without {} where the error passes through zero", fitted.left_out.size());
  return out;
}

/// Why fewer than three points are left.
std::string too_few(const std::vector<OrderPoint>& points, const OrderQuestion& question, std::size_t left) {
  std::size_t floored = 0, dominated = 0;
  // An error that was measured bounds what is in it.
  double named = question.other_error;
  for (const OrderPoint& p : points) {
    if (!std::isfinite(p.error)) continue;
    named = std::min(named, p.error);
    if (question.other_error > 0 && p.error <= above_floor * question.other_error)
      ++dominated;
    else if (p.error <= above_floor * p.floor || p.error == 0)
      ++floored;
  }
  std::string out = fmt::format("{} of {} points usable, three are needed", left, points.size());
  if (dominated) out += fmt::format("; the error of {}, about {:.2g}, dominates {}", question.other, named, dominated);
  if (floored) out += fmt::format("; {} within 4 times the error floor", floored);
  return out;
}

/// Whether the finer points of a window lean towards `target`: then its line says what was, not what will be.
bool leans_towards(const Logs& logs, const Fit& fitted, double target) {
  const Window& w = fitted.window;
  const double gap = target - fitted.slope();
  const auto slope = [&](std::size_t k) { return (logs.y[k + 1] - logs.y[k]) / (logs.x[k + 1] - logs.x[k]); };
  const int towards = drift(logs, w);
  if (towards * gap > 0 && std::abs(slope(w.to - 2) - slope(w.from)) >= slope_change) return true;
  if (w.count() < 5) return false;
  const double finer = line_through(logs, {w.to - std::max<std::size_t>(3, (w.count() + 1) / 2), w.to}).slope;
  return std::abs(target - finer) < 0.5 * std::abs(gap);
}

/// What a refutation must rule out.
struct Doubt {
  bool leans = false;     ///< the finer points move towards the declared order
  std::size_t finer = 0;  ///< usable points beyond the range
};

/// Why an interval away from the declared order does not refute it, or "".
std::string excuse(const OrderFit& fitted, const OrderQuestion& question, const Doubt& doubt) {
  const bool faster = *fitted.order > *question.declared;
  if (doubt.leans) return "but the finer points move towards it";
  if (doubt.finer > 0) return "but the finer points do not follow";
  if (faster && fitted.points < fewest_faster) return fmt::format("but over {} points only", fitted.points);
  if (!faster && question.other_unknown)
    return fmt::format("but the error of {}, which nothing tells, may dominate", question.other);
  return "";
}

void judge(OrderFit& fitted, const OrderQuestion& question, const std::string& span, const Doubt& doubt) {
  if (!question.declared) {
    fitted.reason = "no order is declared; " + span;
    return;
  }
  const double declared = *question.declared, half = 0.5 * (*fitted.high - *fitted.low);
  const double away = std::max({*fitted.low - declared, declared - *fitted.high, 0.0});
  const bool close = std::abs(*fitted.order - declared) <= near && half <= widest_near;
  const char* side = *fitted.order > declared ? "faster" : "slower";
  const std::string but = excuse(fitted, question, doubt);
  if (close || (away == 0 && half <= widest)) {
    fitted.verdict = OrderVerdict::confirmed;
    fitted.reason = fmt::format("agrees with the declared {:.3g}; {}", declared, span);
  } else if (away == 0 || (away < margin && half > widest)) {
    fitted.reason = fmt::format("the interval of ±{:.2g} is too wide to tell; {}", half, span);
  } else if (!but.empty()) {
    fitted.reason = fmt::format("{} than the declared {:.3g}, {}; {}", side, declared, but, span);
  } else if (away < margin) {
    fitted.reason = fmt::format("slightly {} than the declared {:.3g}, by less than the margin of {}; {}", side,
                                declared, margin, span);
  } else {
    fitted.verdict = OrderVerdict::refuted;
    fitted.reason = *fitted.high < falling
                        ? fmt::format("the error does not fall; declared is order {:.3g}; {}", declared, span)
                        : fmt::format("converges {} than the declared {:.3g}; {}", side, declared, span);
  }
}

/// GCI of the three finest points used, where their ratio is constant.
std::optional<double> index_of(const std::vector<OrderPoint>& points, const Logs& logs, const Window& w) {
  if (w.count() < 3) return std::nullopt;
  const std::size_t k = w.to - 3;
  const double coarse = logs.x[k] - logs.x[k + 1], fine = logs.x[k + 1] - logs.x[k + 2];
  if (std::abs(coarse - fine) > 1e-6 * coarse) return std::nullopt;
  const auto value = [&](std::size_t at) {
    const OrderPoint& p = points[logs.index[at]];
    return p.value ? *p.value : p.error;
  };
  const auto found = grid_convergence(value(k), value(k + 1), value(k + 2), std::exp(fine));
  return found ? std::optional(found->index) : std::nullopt;
}

}  // namespace

std::optional<GridConvergence> grid_convergence(double f3, double f2, double f1, double ratio) {
  const double coarse = f3 - f2, fine = f2 - f1;
  if (!(ratio > 1) || !std::isfinite(coarse) || !std::isfinite(fine) || fine == 0 || !(coarse / fine > 1))
    return std::nullopt;
  GridConvergence out;
  out.order = std::log(coarse / fine) / std::log(ratio);
  const double gain = std::pow(ratio, out.order) - 1;
  out.extrapolated = f1 - fine / gain;
  out.index = 1.25 * std::abs(fine) / gain;
  if (!std::isfinite(out.index) || !std::isfinite(out.extrapolated)) return std::nullopt;
  return out;
}

OrderFit fit_order(const std::vector<OrderPoint>& points, const OrderQuestion& question) {
  OrderFit out;
  std::vector<std::size_t> dips;
  const Logs logs = usable(points, question, dips);
  if (logs.size() < 3) {
    out.reason = too_few(points, question, logs.size());
    return out;
  }
  const auto any = [](const Fit&) { return true; };
  const auto falls = [](const Fit& f) { return f.falls(); };
  std::optional<Fit> best = longest(logs, 0, logs.size(), any);
  if (!best) {
    out.reason = fmt::format("no three neighbouring points of {} lie along a line within a factor of 1.5", logs.size());
    return out;
  }
  bool stops_falling = false;
  if (!best->falls()) {
    if (const auto coarser = longest(logs, 0, best->window.from + 1, falls))
      best = coarser;
    else if (best->slope() < falling && best->window.from > 0)
      stops_falling = logs.y[0] - logs.y[best->window.from] > std::log(10.0);
  }
  // A finer range that falls as well: the coarser one was not asymptotic yet.
  while (true) {
    const auto finer = longest(logs, best->window.to - 1, logs.size(), falls);
    if (!finer || finer->window.to < best->window.to + 3) break;
    best = finer;
  }

  const Window& w = best->window;
  out.order = best->slope();
  out.low = *out.order - best->half;
  out.high = *out.order + best->half;
  const double constant = std::exp(best->line.at(0));
  if (std::isfinite(constant) && constant > 0) out.constant = constant;
  out.first = logs.index[w.from];
  out.last = logs.index[w.to - 1];
  out.points = w.count();
  for (const std::size_t k : dips)
    if (points[k].size < points[out.first].size && points[k].size > points[out.last].size) out.left_out.push_back(k);
  out.gci = index_of(points, logs, w);
  std::string span = span_text(points, out, question);
  if (w.from > 0) span += fmt::format("; {} coarser left as pre-asymptotic", w.from);
  if (w.to < logs.size()) span += fmt::format("; {} finer do not follow", logs.size() - w.to);
  out.saturated = stops_falling || *out.high < falling;
  if (stops_falling)
    out.reason = fmt::format("the error stops falling at {:.2g}: something other than the {} dominates; {}",
                             std::exp(best->line.mean_y), question.refined, span);
  else
    judge(out, question, span,
          {question.declared && leans_towards(logs, *best, *question.declared), logs.size() - w.to});
  return out;
}

}  // namespace ricochet
