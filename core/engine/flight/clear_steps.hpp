#pragma once
#include <memory>
#include <ricochet/engine/flight/step_readings.hpp>

namespace ricochet {

/// How many steps lie ahead in which every measure of a motion stays between its bounds. The bound of the motion alone
/// would say it of few steps where some point is near a bound or a fast mode is strong: so it is asked again from where
/// it ends, and the few points that it leaves open are read, as often as they could have reached their bound since: in
/// every step just before they do. What ends it is then the first step in which one does, up to round-off.
class ClearSteps {
 public:
  ClearSteps(const StepRows& rows, FlightBound& bound, const FlightMotion& motion)
      : rows_(rows), bound_(bound), motion_(motion) {}

  /// The largest k ≤ `most` for which they do in the steps that begin 0, 1, …, k steps after (x, e); −1: not in the
  /// first. `ask`: of how many steps to ask first, kept from one count to the next.
  long long count(const std::vector<double>& x, const double* e, long long most, long long& ask);
  /// How many times a point was read for the last count: what it cost beside steps that are marched, which measure all.
  long long read() const { return read_; }
  /// A point of a watch in each step.
  const StepReadings& readings(int watch, int point);

 private:
  // Points that are followed one by one.
  static constexpr std::size_t few = 6;
  struct Followed {
    const StepReadings* reading;
    FlightBound::Differences most;
    double lower, upper;
    long long clear = -1;  // the last step of which it is known to be
  };

  long long follow(long long steps);
  long long clear_steps(const Followed& one);
  bool inside(const Followed& one, int step);
  void advance(long long k);

  const StepRows& rows_;
  FlightBound& bound_;
  const FlightMotion& motion_;
  // Of each watch and point; made when first asked for.
  std::vector<std::vector<std::unique_ptr<StepReadings>>> readings_;
  std::vector<double> x_;
  double e_[3] = {};
  std::vector<WatchedPoint> exposed_;
  std::vector<Followed> followed_;
  long long read_ = 0;
};

}  // namespace ricochet
