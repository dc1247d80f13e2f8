#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ricochet/measure/orbits/shoot.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <tuple>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double parameter_difference = 1e-6, first_step = 1e-3;  // of the range
constexpr int easy = 4, hard = 7, most = 12;                      // iterations
constexpr double growth = 1.5;

}  // namespace

StepFollower::StepFollower(FollowedMap& map, const MapClock& clock, VectorXd x, double parameter, int way,
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
  if (!set_tangent(way)) return;
  keep(now_, last_, multipliers_of(last_.derivative));
  if (limits_.branch.ends_at_image) apart_ = asymmetry(now_);
}

// The direction of the branch at an orbit, λ growing: (1 − P') dx = P_λ dλ.
std::optional<StepFollower::Point> StepFollower::tangent(const Point& at, const MatrixXd& derivative) {
  const MatrixXd one = MatrixXd::Identity(map_->size(), map_->size());
  const VectorXd x = DenseLu(one - derivative).solve(by_parameter(at, parameter_difference));
  const double size = map_->metric().size(x, 1);
  if (!std::isfinite(size)) return std::nullopt;
  return Point{x / size, 1 / size};
}

bool StepFollower::set_tangent(int way) {
  const auto found = tangent(now_, last_.derivative);
  if (found)
    along_ = {way * found->x, way * found->parameter};
  else
    trace_.end = trace_.corners.empty() ? "the branch has no direction at its first orbit"
                                        : fmt::format("the branch has no direction at {:.10g}", now_.parameter);
  return found.has_value();
}

StepFollower::StepFollower(FollowedMap& map, const MapClock& clock, const BranchState& state, const ArcSteps& limits,
                           BranchTrace trace)
    : map_(&map), clock_(clock), limits_(limits), step_(state.step), trace_(std::move(trace)) {
  now_ = {state.x, state.parameter};
  along_ = {state.along, state.parameter_along};
  orientation_ = state.orientation;
  if (limits_.branch.ends_at_image) apart_ = asymmetry(now_);
}

BranchState StepFollower::state() const {
  BranchState state;
  state.x = now_.x;
  state.parameter = now_.parameter;
  state.along = along_.x;
  state.parameter_along = along_.parameter;
  state.step = step_;
  state.orientation = orientation_;
  return state;
}

// By a difference over both sides, or over one where the scene is impossible on the other.
VectorXd StepFollower::by_parameter(const Point& point, double share) {
  const double by = share * (limits_.branch.largest - limits_.branch.least);
  const auto image = [&](double parameter) -> std::optional<VectorXd> {
    try {
      const FollowedMap::Image made = map_->march(point.x, parameter, clock_);
      if (!made.end) return made.image;
      failure_ = text(made.end);
    } catch (const Refusal& refusal) {
      failure_ = refusal.sentence;
    }
    return std::nullopt;
  };
  double width = 2 * by;
  auto low = image(point.parameter - by), high = image(point.parameter + by);
  for (auto* side : {&low, &high}) {
    if (*side) continue;
    *side = image(point.parameter);
    width -= by;
  }
  if (!low || !high || width <= 0) return VectorXd::Constant(map_->size(), NAN);
  return (*high - *low) / width;
}

double StepFollower::overlap(const Point& a, const Point& b) const {
  const StateMetric& metric = map_->metric();
  const double metres = metric.parameter_metres();
  return (metric.rows() * a.x).dot(metric.rows() * b.x) + metres * metres * a.parameter * b.parameter;
}

// x less what the other half of the period makes of it, the sides exchanged.
VectorXd StepFollower::asymmetry(const Point& point) {
  MapClock half = clock_;
  half.half = true;
  return point.x - map_->march(point.x, point.parameter, half).image;
}

// [1 − P', −P_λ], bordered by a direction.
MatrixXd StepFollower::bordered(const MatrixXd& derivative, const VectorXd& slope, const Point& along) const {
  const Index D = map_->size();
  const MatrixXd& rows = map_->metric().rows();
  const double metres = map_->metric().parameter_metres();
  MatrixXd system(D + 1, D + 1);
  system.topLeftCorner(D, D) = MatrixXd::Identity(D, D) - derivative;
  system.topRightCorner(D, 1) = -slope;
  system.bottomLeftCorner(1, D) = (rows.transpose() * (rows * along.x)).transpose();
  system(D, D) = metres * metres * along.parameter;
  return system;
}

// Newton's method on P(x, λ) = x, normal to the secant.
bool StepFollower::correct(Point& point, const Point& along, int& iterations) {
  const Index D = map_->size();
  VectorXd slope;
  double nearest = std::numeric_limits<double>::infinity();
  turned_ = 0;
  for (iterations = 0; iterations <= most; ++iterations) {
    last_ = map_->march(point.x, point.parameter, clock_, true);
    if (last_.end) {
      failure_ = text(last_.end);
      return false;
    }
    const VectorXd left = last_.image - point.x;
    const double residual = map_->metric().size(left);
    // Where an iteration gains nothing any more the rest is round-off.
    if (residual <= limits_.tolerance || (iterations > 1 && residual < largest_round_off && residual > 0.1 * nearest))
      return true;
    // Impacts that rebound are placed to within a step: an orbit is known to that.
    if (residual <= last_.rebounds && residual > 0.5 * nearest) return true;
    nearest = std::min(nearest, residual);
    if (iterations == most) failure_ = fmt::format("the residual stays at {:.3g} m", residual);
    if (slope.size() == 0 || iterations % 3 == 0) slope = by_parameter(point, parameter_difference);
    const MatrixXd system = bordered(last_.derivative, slope, along);
    VectorXd right = VectorXd::Zero(D + 1);
    right.head(D) = left;
    const VectorXd correction = DenseLu(system).solve(right);
    const double size = determinant(system);
    turned_ = (size > 0) - (size < 0);
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

void StepFollower::keep(const Point& point, const FollowedMap::Image& image,
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
  trace_.rebounds = std::max(trace_.rebounds, image.rebounds);
  trace_.corners.push_back(std::move(corner));
  trace_.states.emplace(static_cast<long long>(trace_.corners.size()) - 1, point.x);
}

// Marks between the last orbit and the next one, solved from between them.
void StepFollower::mark_up_to(const Point& next) {
  for (const double mark : limits_.branch.marks) {
    const double share = (mark - now_.parameter) / (next.parameter - now_.parameter);
    if (!(share >= 0) || share > 1) continue;
    const VectorXd by = next.x - now_.x;
    const ShotOrbit at = shoot(*map_, now_.x + share * by, mark, clock_, limits_.tolerance);
    if (!at.found) continue;
    const FollowedMap::Image image = map_->march(at.x, mark, clock_);
    const BranchCorner& corner = trace_.corners.back();
    const double arc = corner.arc + map_->metric().size(at.x - now_.x, mark - now_.parameter);
    const bool known = !trace_.marks.empty() && trace_.marks.back().parameter == mark &&
                       std::abs(trace_.marks.back().arc - arc) <= smallest_step * arc;
    if (!known) trace_.marks.push_back({mark, arc, image.tip, pieces() - 1, at.x});
  }
}

// Ends the branch at an end of the range, where a point is beyond it and the branch goes there.
bool StepFollower::leaves(const Point& next) {
  const BranchLimits& limits = limits_.branch;
  if (next.parameter >= limits.least && next.parameter <= limits.largest) return false;
  const double limit = next.parameter < limits.least ? limits.least : limits.largest;
  const double share = (limit - now_.parameter) / (next.parameter - now_.parameter);
  const ShotOrbit at = shoot(*map_, now_.x + share * (next.x - now_.x), limit, clock_, limits_.tolerance);
  if (!at.found) return false;
  const Point end{at.x, limit}, by{at.x - now_.x, limit - now_.parameter};
  const double far = map_->metric().size(by.x, by.parameter);
  if (far > step_ * growth || overlap(by, along_) < sharpest * far) return false;
  trace_.corners.back().way = along_.parameter < 0 ? -1 : 1;
  mark_up_to(end);
  const FollowedMap::Image image = map_->march(at.x, limit, clock_, true);
  keep(end, image, multipliers_of(image.derivative));
  trace_.end = fmt::format("the range ends at {:.10g}", limit);
  return true;
}

// Whether the first orbit lies on the step to the next one, which goes the same way.
bool StepFollower::comes_back(double far) const {
  constexpr std::size_t fewest = 8;
  constexpr double aside = 0.05;  // of the step
  if (trace_.corners.size() < fewest || trace_.corners.front().way != trace_.corners.back().way) return false;
  const Point back{trace_.states.at(0) - now_.x, trace_.corners.front().parameter - now_.parameter};
  const double along = overlap(back, along_), length = std::sqrt(overlap(back, back));
  return along >= 0 && along <= far && std::sqrt(std::max(0.0, length * length - along * along)) < aside * far;
}

bool StepFollower::advance(long long steps) {
  const StateMetric& metric = map_->metric();
  const BranchLimits& limits = limits_.branch;
  const double range = metric.parameter_metres() * (limits.largest - limits.least);
  for (; steps > 0 && !trace_.ended(); --steps) {
    Point next, by;
    std::vector<std::complex<double>> multipliers;
    int iterations = 0;
    const Point before = along_;
    const int runs = trace_.corners.back().runs, above = trace_.corners.back().raw.outside.above;
    // Of a smooth map: the shortest step so far that changes what is placed. No shorter one may be found where contacts
    // come or go that the map does not resolve.
    std::optional<std::pair<Point, FollowedMap::Image>> across;
    bool jumps = false;
    double far = 0;
    for (;; step_ *= 0.5) {
      jumps = limits_.smooth && step_ < 0.01 * limits_.located * range;
      if (jumps && across) std::tie(next, last_) = std::move(*across);
      if (jumps && (across || pass_graze(next))) {
        multipliers = multipliers_of(last_.derivative);
        step_ = limits_.located * range;
        break;
      }
      if (step_ < smallest_step * range && (limits_.smooth || !turn_corner())) {
        const bool graze = trace_.rebounds > 0 && last_.runs != trace_.corners.back().runs;
        if (graze)
          trace_.end =
              fmt::format("the derivative is infinite at a graze with e > 0; ended at speed {:.3g} m/s, λ = {:.10g}",
                          last_.slowest, now_.parameter);
        else
          trace_.end = fmt::format("the branch was left at λ = {:.10g}: {}step below {:.3g} m; {}", now_.parameter,
                                   jumps ? "no orbit was found beyond a contact that comes or goes; " : "",
                                   smallest_step * range, failure_);
        return false;
      }
      next = {now_.x + step_ * along_.x, now_.parameter + step_ * along_.parameter};
      if (leaves(next)) return false;
      try {
        if (!correct(next, along_, iterations)) continue;
      } catch (const Refusal& refusal) {  // of a value of the parameter
        failure_ = refusal.sentence;
        continue;
      }
      by = {next.x - now_.x, next.parameter - now_.parameter};
      far = metric.size(by.x, by.parameter);
      const double cosine = overlap(by, along_) / far;
      multipliers = multipliers_of(last_.derivative);
      bool crosses = outside(multipliers).total != trace_.corners.back().raw.outside.total;
      if (limits_.smooth) crosses |= last_.runs != runs;
      if (limits_.smooth && (outside(multipliers).above - above) % 2 == 0 &&
          (next.parameter - now_.parameter) * along_.parameter < 0) {
        failure_ = "the step goes back along the branch";
        continue;
      }
      // Nearer than impacts are placed neither directions nor multipliers say anything.
      const double told = 5 * last_.rebounds;
      const bool straight = cosine >= sharpest || (far < told && cosine > 0);
      if (!limits_.smooth && last_.rebounds == 0 && turned_ * orientation_ < 0) {
        failure_ = "the next orbit goes back along the branch";
        continue;
      }
      if (straight && crosses && step_ > std::max(limits_.located * range, told)) {
        if (limits_.smooth) across = {next, last_};
        continue;
      }
      if (straight) break;
      failure_ = "the branch turns by more than 45 degrees within a step";
    }
    by = {next.x - now_.x, next.parameter - now_.parameter};
    far = metric.size(by.x, by.parameter);
    if (orientation_ == 0) orientation_ = turned_;
    along_ = {by.x / far, by.parameter / far};
    if (leaves(next)) return false;
    if (next.parameter < limits.least || next.parameter > limits.largest) {
      trace_.end =
          fmt::format("the range ends at {:.10g}", next.parameter < limits.least ? limits.least : limits.largest);
      return false;
    }
    if (apart_.size() > 0) {
      const VectorXd there = asymmetry(next);
      if (there.dot(apart_) < 0) {
        trace_.end = fmt::format("its orbits become their own images at {:.10g}", next.parameter);
        return false;
      }
      apart_ = there;
    }
    mark_up_to(next);
    if (comes_back(far)) {
      trace_.end = "closed: the branch came back to its first orbit";
      return false;
    }
    const bool turns = (outside(multipliers).above - above) % 2 != 0, contact = last_.runs != runs;
    if (limits_.smooth && contact) place_contact(next, before, turns);
    // The secant that ends here is that of the corner before.
    trace_.corners.back().way = next.parameter < now_.parameter ? -1 : 1;
    keep(next, last_, std::move(multipliers));
    now_ = std::move(next);
    // λ turns where det(1 − P') changes its sign. A secant over a corner or a jump is no direction of the branch.
    if (limits_.smooth && (jumps || turns || contact) && !set_tangent(turns == (before.parameter > 0) ? -1 : 1)) break;
    if (iterations <= easy) step_ = std::min(growth * step_, largest_step * range);
    if (iterations > hard) step_ /= growth;
    if (pieces() > limits.pieces)
      trace_.end = fmt::format("{} steps, the most that the study allows", limits.pieces);
    else if (trace_.corners.back().arc >= limits.arc)
      trace_.end = fmt::format("an arc of {:g} m, the longest that the study allows", limits.arc);
  }
  return !trace_.ended();
}

}  // namespace ricochet
