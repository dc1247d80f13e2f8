#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

/// Weighted mean and deviation of numbers as they come (Welford): no difference of large squares.
struct RunningMoments {
  double weight = 0, mean = 0, squares = 0;  ///< squares: Σ w (x − mean)²
  double least = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();

  void add(double x, double w = 1) {
    weight += w;
    const double apart = x - mean;
    mean += w / weight * apart;
    squares += w * apart * (x - mean);
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
  void add(const RunningMoments& other) {
    if (other.weight == 0) return;
    const double apart = other.mean - mean, all = weight + other.weight;
    squares += other.squares + apart * apart * weight * other.weight / all;
    mean += other.weight / all * apart;
    weight = all;
    least = std::min(least, other.least);
    largest = std::max(largest, other.largest);
  }
  bool any() const { return weight > 0; }
  double deviation() const { return any() ? std::sqrt(squares / weight) : 0; }
  double rms() const { return any() ? std::hypot(mean, deviation()) : 0; }
};

/// An interval of time in equal parts.
struct WindowParts {
  double from = 0, to = 0;  ///< s
  int count = 1;

  double length() const { return (to - from) / count; }
  double begin(int part) const { return from + (to - from) * part / count; }
  /// The part that holds t, which may be off by `slack`; −1 for one outside. An end belongs to the part before it.
  int of(double t, double slack) const {
    if (t <= from + slack || t > to + slack) return -1;
    return std::clamp(static_cast<int>(std::ceil((t - slack - from) / length())) - 1, 0, count - 1);
  }
};

}  // namespace ricochet
