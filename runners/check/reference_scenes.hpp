#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/reference.hpp>
#include <string>
#include <vector>

#include "runners/check/parameter_values.hpp"

namespace ricochet::checking {

/// m w'' + c w' + k w = constant + Σ (a cos ωt + b sin ωt), in closed form, for c² < 4mk.
class HarmonicMotion {
 public:
  struct Term {
    double cosine = 0, sine = 0, pulsation = 0;
  };
  /// From w and w' at time `start`.
  HarmonicMotion(double m, double c, double k, double constant, std::vector<Term> terms, double w, double v,
                 double start = 0);
  double displacement(double t) const;
  double velocity(double t) const;

 private:
  double decay_, ringing_, rest_, start_;
  std::vector<Term> response_;
  double along_ = 0, across_ = 0;  // of the free part
};

/// The slope of log error over log h through the last three pairs, and whether errors are round-off already.
struct MeasuredOrder {
  double order = 0;
  double finest = 0;  ///< error at the smallest step
  bool exact = false;
};
/// `scale`: of the motion; errors below 1e-11 of it are no longer told from round-off.
MeasuredOrder measured_order(const std::vector<double>& steps, const std::vector<double>& errors, double scale);

using Reference = Subject<ReferenceSolver>;

/// A scene that a reference is asked about, with the matrices of a mesh for those that need them.
struct ReferenceScene {
  std::string name;
  ReferenceProblem problem;
  SampleGrid grid;
  double tip = 0;                       ///< where it is, m
  std::function<double(double)> exact;  ///< its displacement where a closed form is known here, else empty
  std::shared_ptr<const DiscreteProblem> discrete;
};

/// A free oscillator, a forced one, a bouncing one, a bar on its stop, a cantilever against a stop.
std::vector<ReferenceScene> reference_scenes();

}  // namespace ricochet::checking
