#pragma once
#include <ricochet/scene/history/time_history.hpp>

namespace ricochet::testing {

/// φ = v t.
struct Steady final : TimeHistory {
  explicit Steady(double speed) : v(speed) {}
  double value(double t) const override { return v * t; }
  double rate(double) const override { return v; }
  double acceleration(double) const override { return 0; }
  double v;
};

}  // namespace ricochet::testing
