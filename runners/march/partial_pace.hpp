#pragma once
#include <algorithm>
#include <chrono>

#include "runners/march/seconds.hpp"

namespace ricochet {

/// When a long case shows what it has so far: every 20 s, and never so often that showing takes more than a twentieth
/// of the time.
class PartialPace {
 public:
  bool due() const { return seconds_since(shown_) >= std::max(interval, 20 * cost_); }
  /// Calls `show` and notes what it took.
  template <class Show>
  void take(Show show) {
    const auto begin = Clock::now();
    show();
    cost_ = seconds_since(begin);
    shown_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double interval = 20;  // s
  Clock::time_point shown_ = Clock::now();
  double cost_ = 0;  // s
};

}  // namespace ricochet
