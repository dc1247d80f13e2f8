#pragma once
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {

/// A watch in each of `block` steps that begin one after the other, from the state before them alone: by rows
/// r, r A, r A², … of each mode.
class StepReadings {
 public:
  static constexpr int power = 4, block = 1 << power;

  /// `points` of the watch as FlightBound has them.
  StepReadings(const StepRows& rows, const FlightWatch& watch, const double* points);

  /// What each mode has `step` ≤ block steps after (x, e).
  void modes(int step, const double* x, const double* e, double* out) const;
  /// A point of the watch then; `modes`: of that step.
  double value(int point, int step, const double* modes, const double* e) const;

 private:
  const double* points_;
  int count_, modes_, slots_, drives_;
  std::vector<double> table_;  // of each step: width × modes
  std::vector<double> drive_;  // of each step: points × drives
};

}  // namespace ricochet
