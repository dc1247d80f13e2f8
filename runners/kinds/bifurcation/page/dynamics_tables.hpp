#pragma once
#include <algorithm>
#include <cmath>

namespace ricochet::report {

/// What some numbers reach; empty until a finite one is included.
struct Interval {
  double low = 0, high = 0;
  bool empty() const { return !(low <= high); }
  static Interval nothing() { return {1, -1}; }
  void include(double value) {
    if (!std::isfinite(value)) return;
    if (empty()) low = high = value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void include(const Interval& other) {
    if (other.empty()) return;
    include(other.low);
    include(other.high);
  }
};

}  // namespace ricochet::report
