#pragma once
#include <algorithm>
#include <ricochet/engine/flight/flight_bound.hpp>
#include <ricochet/engine/flight/flight_motion.hpp>

namespace ricochet {

/// One point of a watch in each of `block` steps that begin one after the other, from the state before them alone: by
/// rows h r, h r A, h r A², …; h is the point over the modes.
class StepReadings {
 public:
  static constexpr int block = 8;

  StepReadings(const StepRows& rows, const FlightWatch& watch, int point);

  /// `step` ≤ block steps after (x, e).
  double operator()(int step, const double* x, const double* e) const;
  /// It in each of the first `steps` ≤ block steps.
  void first(int steps, const double* x, const double* e, double* out) const { read(0, steps, x, e, out); }
  /// Its value in the step that begins now, and its first, second and third differences over those that follow: by h r,
  /// h r D, h r D² and h r D³, so that what they differ by is not lost in their sizes.
  void differences(const double* x, const double* e, double out[4]) const {
    read(differences_from, differences_read, x, e, out);
  }
  /// `see`(value) in each of `steps` steps from (x, e) on, which go on to where the last block ends.
  template <class See>
  void each(const FlightMotion& motion, long long steps, double* x, double* e, See&& see) const {
    for (long long first = 0; first < steps; first += block) {
      const int count = static_cast<int>(std::min<long long>(block, steps - first));
      double values[block];
      this->first(count, x, e, values);
      for (int step = 0; step < count; ++step) see(values[step]);
      motion.advance(block, x, e);
    }
  }

 private:
  static constexpr int differences_from = block + 1, differences_read = 4,
                       rows_read = differences_from + differences_read;

  void read(int first, int count, const double* x, const double* e, double* out) const;

  int size_, drives_;
  std::vector<double> weights_, drive_;  // of each step, then of each difference: slots × modes, drives
};

}  // namespace ricochet
