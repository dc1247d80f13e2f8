#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

/// \file
/// Between two looks a watched quantity g is its cubic Hermite interpolant, within (δ⁴/384) max|g''''|.
namespace ricochet::event_driven {

/// What a bound leaves of |e^{rτ}| between two looks δ apart, x = |r|δ: the interpolation error while it is small, the
/// function and its interpolant where it is not.
inline double interpolation_loss(double x) {
  return std::min(x * x * x * x / 384, 1 + 0.3 * x);
}

/// Cubic on s ∈ [0, 1] through values and slopes (per unit of s) at both ends.
struct Cubic {
  double start, start_slope, end, end_slope;

  double at(double s) const {
    const double rise = end - start, b = 3 * rise - 2 * start_slope - end_slope, c = start_slope + end_slope - 2 * rise;
    return start + s * (start_slope + s * (b + s * c));
  }

  /// Where it turns inside ]0, 1[, in order; entries beyond the last turn are 1.
  std::array<double, 2> turns() const {
    const double rise = end - start, b = 3 * rise - 2 * start_slope - end_slope,
                 c = 3 * (start_slope + end_slope - 2 * rise);
    std::array<double, 2> result = {1, 1};
    const double discriminant = b * b - c * start_slope;
    if (discriminant <= 0) return result;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const auto keep = [](double s) { return s > 0 && s < 1 ? s : 1.0; };
    result = {keep(c != 0 ? q / c : 1), keep(q != 0 ? start_slope / q : 1)};
    std::sort(result.begin(), result.end());
    return result;
  }
};

/// One bound that ends a phase when g passes it. Just after a switch the truncated expansion may leave g a hair beyond
/// the bound: the guard is then off until g has been further inside than `slack`, or the time `until` has come, and
/// meanwhile passing the bound by more than the slack ends the phase as well.
struct Guard {
  double bound = 0;
  int inside = 1;  ///< +1: g stays above; −1: below
  double slack = 0;
  bool on = true;
  double until = std::numeric_limits<double>::infinity();

  double margin(double g) const { return inside * (g - bound); }
  double threshold() const { return on ? 0 : -slack; }
  bool waits() const { return !on && std::isfinite(until); }
  void look(double t, double g) { on = on || margin(g) > slack || t >= until; }

  /// Smallest margin of a cubic.
  double least(const Cubic& cubic) const {
    double result = std::min(margin(cubic.start), margin(cubic.end));
    for (const double s : cubic.turns())
      if (s < 1) result = std::min(result, margin(cubic.at(s)));
    return result;
  }
  /// First end or turn of a cubic where the margin is below the threshold by more than `tolerance`.
  std::optional<double> passed_by(const Cubic& cubic, double tolerance) const {
    for (const double s : cubic.turns())
      if (margin(cubic.at(s)) < threshold() - tolerance) return s;
    if (margin(cubic.end) < threshold() - tolerance) return 1;
    return std::nullopt;
  }
};

/// Root of a margin that falls from `low` (≥ 0 there) to `high` (< 0 there): Newton kept inside a shrinking bracket.
/// `f` returns value and slope.
template <class Function>
double falling_root(const Function& f, double low, double high) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 100; ++i) {
    const auto [value, slope] = f(x);
    if (value == 0) return x;
    (value > 0 ? low : high) = x;
    double next = x - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-15 * high) return next;
    x = next;
  }
  return x;
}

}  // namespace ricochet::event_driven
