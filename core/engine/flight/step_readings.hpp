#pragma once
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {

/// One point of a watch in each of `block` steps that begin one after the other, from the state before them alone: by
/// rows h r, h r A, h r A², …
class StepReadings {
 public:
  static constexpr int block = 8;

  /// `row`: the point over the modes; `point`: which of the watch.
  StepReadings(const StepRows& rows, const FlightWatch& watch, int point, const double* row);

  /// `step` ≤ block steps after (x, e).
  double operator()(int step, const double* x, const double* e) const;

 private:
  int size_, drives_;
  std::vector<double> weights_, drive_;  // of each step: slots × modes, drives
};

}  // namespace ricochet
