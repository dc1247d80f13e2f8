#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/shoot.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double parameter_difference = 1e-6, smallest_step = 1e-9, first_step = 1e-3;  // of the range
constexpr int easy = 4, hard = 7, most = 12;                                            // iterations
constexpr double located = 1e-4, largest_step = 0.05;  // of the range: where the count outside changes, and elsewhere
constexpr double growth = 1.5, sharpest = 0.70710678118654752;  // cos 45°

}  // namespace

StepFollower::StepFollower(SteppedMap& map, const MapClock& clock, VectorXd x, double parameter, int way,
                           const ArcSteps& limits)
    : map_(&map), clock_(clock), limits_(limits) {
  now_ = {std::move(x), parameter};
  const double range = map.metric().parameter_metres() * (limits.branch.largest - limits.branch.least);
  step_ = limits.first > 0 ? limits.first : first_step * range;
  last_ = map.march(now_.x, parameter, clock, true);
  if (last_.end) {
    trace_.end = "the first orbit cannot be marched: " + text(last_.end);
    return;
  }
  // The direction of the branch: (1 − P') dx = P_λ dλ.
  const MatrixXd one = MatrixXd::Identity(map.size(), map.size());
  along_.x = DenseLu(one - last_.derivative).solve(by_parameter(now_));
  along_.parameter = 1;
  const double size = map.metric().size(along_.x, along_.parameter);
  if (!std::isfinite(size)) {
    trace_.end = "the branch has no direction at its first orbit";
    return;
  }
  along_.x *= way / size;
  along_.parameter *= way / size;
  keep(now_, last_, multipliers_of(last_.derivative));
}

VectorXd StepFollower::by_parameter(const Point& point) {
  const double range = limits_.branch.largest - limits_.branch.least, by = parameter_difference * range;
  const auto low = map_->march(point.x, point.parameter - by, clock_),
             high = map_->march(point.x, point.parameter + by, clock_);
  if (low.end || high.end) return VectorXd::Constant(map_->size(), NAN);
  return (high.image - low.image) / (2 * by);
}

// Newton's method on P(x, λ) = x, normal to the secant.
bool StepFollower::correct(Point& point, const Point& along, int& iterations) {
  const Index D = map_->size();
  const MatrixXd& rows = map_->metric().rows();
  const VectorXd normal = rows.transpose() * (rows * along.x);
  const double metres = map_->metric().parameter_metres();
  VectorXd slope;
  double nearest = std::numeric_limits<double>::infinity();
  for (iterations = 0; iterations <= most; ++iterations) {
    last_ = map_->march(point.x, point.parameter, clock_, true);
    if (last_.end) {
      failure_ = text(last_.end);
      return false;
    }
    const VectorXd left = last_.image - point.x;
    const double residual = map_->metric().size(left);
    if (residual <= limits_.tolerance) return true;
    // Impacts that rebound are placed to within a step: an orbit is known to that.
    if (residual <= last_.rebounds && residual > 0.5 * nearest) return true;
    nearest = std::min(nearest, residual);
    if (iterations == most) failure_ = fmt::format("the residual stays at {:.3g} m", residual);
    if (slope.size() == 0 || iterations % 3 == 0) slope = by_parameter(point);
    MatrixXd system(D + 1, D + 1);
    system.topLeftCorner(D, D) = MatrixXd::Identity(D, D) - last_.derivative;
    system.topRightCorner(D, 1) = -slope;
    system.bottomLeftCorner(1, D) = normal.transpose();
    system(D, D) = metres * metres * along.parameter;
    VectorXd right = VectorXd::Zero(D + 1);
    right.head(D) = left;
    const VectorXd correction = DenseLu(system).solve(right);
    if (!correction.allFinite()) {
      failure_ = "a multiplier is 1 and the branch has no direction";
      return false;
    }
    point.x += correction.head(D);
    point.parameter += correction[D];
  }
  return false;
}

ShotOrbit StepFollower::towards(const VectorXd& x, double parameter, double arc) {
  const StateMetric& metric = map_->metric();
  const VectorXd by = x - now_.x;
  const double far = metric.size(by, parameter - now_.parameter);
  const Point along{by / far, (parameter - now_.parameter) / far};
  Point point{now_.x + arc * along.x, now_.parameter + arc * along.parameter};
  ShotOrbit orbit;
  orbit.found = correct(point, along, orbit.iterations);
  orbit.end = last_.end;
  if (!last_.end) orbit.residual = metric.size(last_.image - point.x);
  orbit.x = std::move(point.x);
  orbit.parameter = point.parameter;
  return orbit;
}

void StepFollower::keep(const Point& point, const SteppedMap::Image& image,
                        std::vector<std::complex<double>> multipliers) {
  BranchCorner corner;
  corner.parameter = point.parameter;
  corner.arc = trace_.corners.empty() ? 0 : trace_.corners.back().arc;
  if (!trace_.corners.empty()) {
    const VectorXd by = point.x - now_.x;
    corner.arc += map_->metric().size(by, point.parameter - now_.parameter);
  }
  corner.tip = image.tip;
  corner.way = along_.parameter < 0 ? -1 : 1;
  corner.runs = image.runs;
  corner.shortest = image.shortest;
  corner.raw = corner.smooth = roots_at(multipliers);
  multipliers.resize(std::min(multipliers.size(), static_cast<std::size_t>(limits_.branch.multipliers)));
  corner.leading = std::move(multipliers);
  corner.residual = map_->metric().size(image.image - point.x);
  rebounds_ = std::max(rebounds_, image.rebounds);
  trace_.corners.push_back(std::move(corner));
  trace_.states.emplace(static_cast<long long>(trace_.corners.size()) - 1, point.x);
}

bool StepFollower::advance(long long steps) {
  const StateMetric& metric = map_->metric();
  const BranchLimits& limits = limits_.branch;
  const double range = metric.parameter_metres() * (limits.largest - limits.least);
  for (; steps > 0 && !trace_.ended(); --steps) {
    Point next;
    std::vector<std::complex<double>> multipliers;
    int iterations = 0;
    for (;; step_ *= 0.5) {
      if (step_ < smallest_step * range) {
        const bool graze = rebounds_ > 0 && last_.runs != trace_.corners.back().runs;
        if (graze)
          trace_.end = fmt::format(
              "the derivative is infinite at a graze with e > 0; ended at a speed of {:.3g} m/s, at "
              "{:.10g}",
              last_.slowest, now_.parameter);
        else
          trace_.end = fmt::format("the branch was left at {:.10g}: step below {:.3g} m; {}", now_.parameter,
                                   smallest_step * range, failure_);
        return false;
      }
      next = {now_.x + step_ * along_.x, now_.parameter + step_ * along_.parameter};
      try {
        if (!correct(next, along_, iterations)) continue;
      } catch (const Refusal& refusal) {  // of a value of the parameter
        failure_ = refusal.sentence;
        continue;
      }
      const VectorXd by = next.x - now_.x;
      const double far = metric.size(by, next.parameter - now_.parameter);
      const double metres = metric.parameter_metres();
      const double cosine = ((metric.rows() * by).dot(metric.rows() * along_.x) +
                             metres * metres * (next.parameter - now_.parameter) * along_.parameter) /
                            far;
      multipliers = multipliers_of(last_.derivative);
      const bool crosses = outside(multipliers).total != trace_.corners.back().raw.outside.total;
      // Nearer than impacts are placed neither directions nor multipliers say anything.
      const double told = 5 * last_.rebounds;
      const bool straight = cosine >= sharpest || (far < told && cosine > 0);
      if (straight && crosses && step_ > std::max(located * range, told)) continue;
      if (straight) break;
      failure_ = "the branch turns by more than 45 degrees within a step";
    }
    const VectorXd by = next.x - now_.x;
    const double far = metric.size(by, next.parameter - now_.parameter);
    along_ = {by / far, (next.parameter - now_.parameter) / far};
    if (next.parameter < limits.least || next.parameter > limits.largest) {
      const double limit = next.parameter < limits.least ? limits.least : limits.largest;
      const double share = (limit - now_.parameter) / (next.parameter - now_.parameter);
      const ShotOrbit at = shoot(*map_, now_.x + share * by, limit, clock_, limits_.tolerance);
      if (at.found) {
        const Point end{at.x, limit};
        const SteppedMap::Image image = map_->march(at.x, limit, clock_, true);
        keep(end, image, multipliers_of(image.derivative));
      }
      trace_.end = fmt::format("the range ends at {:.10g}", limit);
      return false;
    }
    // The secant that ends here is that of the corner before.
    trace_.corners.back().way = along_.parameter < 0 ? -1 : 1;
    keep(next, last_, std::move(multipliers));
    now_ = std::move(next);
    if (iterations <= easy) step_ = std::min(growth * step_, largest_step * range);
    if (iterations > hard) step_ /= growth;
    if (static_cast<long long>(trace_.corners.size()) > limits.pieces)
      trace_.end = fmt::format("{} steps, the most that the study allows", limits.pieces);
    else if (trace_.corners.back().arc >= limits.arc)
      trace_.end = fmt::format("an arc of {:g} m, the longest that the study allows", limits.arc);
  }
  return !trace_.ended();
}

}  // namespace ricochet
