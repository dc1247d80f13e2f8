#pragma once
#include <cmath>

namespace ricochet {

/// A quantity over time that has two derivatives. Any number of threads may ask.
class TimeHistory {
 public:
  virtual ~TimeHistory() = default;
  virtual double value(double t) const = 0;
  virtual double rate(double t) const = 0;
  virtual double acceleration(double t) const = 0;
};

/// A sin(ωt + ψ).
class HarmonicMotion : public TimeHistory {
 public:
  HarmonicMotion(double amplitude, double pulsation, double phase)
      : amplitude_(amplitude), pulsation_(pulsation), phase_(phase) {}
  double value(double t) const override { return amplitude_ * std::sin(pulsation_ * t + phase_); }
  double rate(double t) const override { return amplitude_ * pulsation_ * std::cos(pulsation_ * t + phase_); }
  double acceleration(double t) const override { return -pulsation_ * pulsation_ * value(t); }

 private:
  double amplitude_, pulsation_, phase_;
};

}  // namespace ricochet
