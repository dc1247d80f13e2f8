#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <utility>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double parameter_difference = 1e-6, first_step = 1e-3;  // of the range
constexpr int easy = 4, hard = 7, most = 12;                      // iterations
constexpr double growth = 1.5, most_steps = 10;

}  // namespace

StepFollower::StepFollower(FollowedMap& map, const MapClock& clock, VectorXd x, double parameter, int way,
                           const ArcSteps& limits)
    : map_(&map), clock_(clock), limits_(limits) {
  now_ = {std::move(x), parameter};
  step_ = limits.first > 0 ? limits.first : first_step * range();
  QuietOrbit at{now_.x, clock};
  Step first{now_, march_quiet(map, at, parameter)};
  now_.x = first.to.x = at.x;
  clock_ = at.clock;
  if (first.image.end) {
    trace_.end_by(TraceEnd::left, "the first orbit cannot be marched: " + text(first.image.end));
    return;
  }
  first_ = now_.x;
  if (!set_tangent(way, first.image.derivative)) return;
  first.multipliers = multipliers_of(first.image.derivative);
  orientation_ = way * outside(first.multipliers).side();
  keep(std::move(first));
  if (!within(now_))
    trace_.end_by(TraceEnd::left, fmt::format("its first orbit is beyond the range, at {:.10g}", parameter));
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

bool StepFollower::set_tangent(int way, const MatrixXd& derivative) {
  const auto found = tangent(now_, derivative);
  if (found)
    along_ = {way * found->x, way * found->parameter};
  else
    trace_.end_by(TraceEnd::left, trace_.corners.empty()
                                      ? "the branch has no direction at its first orbit"
                                      : fmt::format("the branch has no direction at {:.10g}", now_.parameter));
  return found.has_value();
}

StepFollower::StepFollower(FollowedMap& map, const MapClock& clock, const BranchState& state, const ArcSteps& limits,
                           BranchTrace trace)
    : map_(&map), clock_(clock), limits_(limits), step_(state.step), trace_(std::move(trace)) {
  now_ = {state.x, state.parameter};
  along_ = {state.along, state.parameter_along};
  orientation_ = state.orientation;
  clock_.begins = state.begins;
  first_ = first_orbit();
  if (limits_.branch.ends_at_image) apart_ = asymmetry(now_);
}

BranchState StepFollower::state() const {
  return {now_.x, now_.parameter, {}, along_.x, along_.parameter, {}, 0, 0, step_, orientation_, clock_.begins};
}

double StepFollower::range() const {
  return map_->metric().parameter_metres() * (limits_.branch.largest - limits_.branch.least);
}

bool StepFollower::within(const Point& point) const {
  return point.parameter >= limits_.branch.least && point.parameter <= limits_.branch.largest;
}

std::optional<FollowedMap::Image> StepFollower::image_of(const Point& point, bool derivative) {
  return image_over(point, clock_, derivative);
}

std::optional<FollowedMap::Image> StepFollower::image_over(const Point& point, const MapClock& clock, bool derivative) {
  try {
    FollowedMap::Image made = map_->march(point.x, point.parameter, clock, derivative);
    if (!made.end) return made;
    failure_ = text(made.end);
  } catch (const Refusal& refusal) {
    failure_ = refusal.sentence.text;
  }
  return std::nullopt;
}

// By a difference over both sides, or over one where the scene is impossible on the other.
VectorXd StepFollower::by_parameter(const Point& point, double share) {
  const double by = share * (limits_.branch.largest - limits_.branch.least);
  double width = 2 * by;
  auto low = image_of({point.x, point.parameter - by}), high = image_of({point.x, point.parameter + by});
  for (auto* side : {&low, &high}) {
    if (*side) continue;
    *side = image_of(point);
    width -= by;
  }
  if (!low || !high || width <= 0) return VectorXd::Constant(map_->size(), NAN);
  return (high->image - low->image) / width;
}

double StepFollower::overlap(const Point& a, const Point& b) const {
  const StateMetric& metric = map_->metric();
  const double metres = metric.parameter_metres();
  return (metric.rows() * a.x).dot(metric.rows() * b.x) + metres * metres * a.parameter * b.parameter;
}

std::pair<StepFollower::Point, double> StepFollower::secant_to(const Point& point) const {
  const Point by{point.x - now_.x, point.parameter - now_.parameter};
  const double far = map_->metric().size(by.x, by.parameter);
  return {{by.x / far, by.parameter / far}, far};
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

// Newton's method on P(x, λ) = x from a point, normal to a direction.
bool StepFollower::correct(Step& step, const Point& along) {
  const Index D = map_->size();
  VectorXd slope;
  double nearest = std::numeric_limits<double>::infinity();
  step.turned = 0;
  for (step.iterations = 0; step.iterations <= most; ++step.iterations) {
    auto made = image_of(step.to, true);
    if (!made) return false;
    step.image = std::move(*made);
    const VectorXd left = step.image.image - step.to.x;
    const double residual = map_->metric().size(left);
    // Where an iteration gains nothing any more the rest is round-off.
    if (residual <= limits_.tolerance ||
        (step.iterations > 1 && residual < largest_round_off && residual > 0.1 * nearest))
      return true;
    // Impacts that rebound are placed to within a step: an orbit is known to that.
    if (residual <= step.image.rebounds && residual > 0.5 * nearest) return true;
    nearest = std::min(nearest, residual);
    if (step.iterations == most) failure_ = fmt::format("the residual stays at {:.3g} m", residual);
    if (step.iterations % 3 == 0) slope = by_parameter(step.to, parameter_difference);
    const MatrixXd system = bordered(step.image.derivative, slope, along);
    VectorXd right = VectorXd::Zero(D + 1);
    right.head(D) = left;
    const VectorXd correction = DenseLu(system).solve(right);
    const double size = determinant(system);
    step.turned = (size > 0) - (size < 0);
    if (!correction.allFinite()) {
      failure_ = "a multiplier is 1 and the branch has no direction";
      return false;
    }
    step.to.x += correction.head(D);
    step.to.parameter += correction[D];
    // Beyond the range the scene may not be possible, or be another one.
    const double beyond = largest_step * (limits_.branch.largest - limits_.branch.least);
    if (step.to.parameter < limits_.branch.least - beyond || step.to.parameter > limits_.branch.largest + beyond) {
      failure_ = fmt::format("Newton's method goes beyond the range, to {:.4g}", step.to.parameter);
      return false;
    }
  }
  return false;
}

ShotOrbit StepFollower::towards(const VectorXd& x, double parameter, double arc) {
  const Point along = secant_to({x, parameter}).first;
  Step step{{now_.x + arc * along.x, now_.parameter + arc * along.parameter}};
  ShotOrbit orbit;
  orbit.found = correct(step, along);
  orbit.iterations = step.iterations;
  if (orbit.found) orbit.residual = map_->metric().size(step.image.image - step.to.x);
  orbit.x = orbit.found ? std::move(step.image.strobe) : std::move(step.to.x);
  orbit.parameter = step.to.parameter;
  return orbit;
}

void StepFollower::keep(Step step) {
  if (step.multipliers.empty()) step.multipliers = multipliers_of(step.image.derivative);
  BranchCorner corner;
  corner.parameter = step.to.parameter;
  if (!trace_.corners.empty()) corner.arc = trace_.corners.back().arc + secant_to(step.to).second;
  corner.tip = step.image.tip;
  corner.way = along_.parameter < 0 ? -1 : 1;
  corner.runs = step.image.runs;
  corner.held = step.image.held;
  corner.shortest = step.image.shortest;
  corner.raw = corner.smooth = roots_at(step.multipliers);
  corner.leading = limits_.branch.leading(std::move(step.multipliers));
  corner.residual = map_->metric().size(step.image.image - step.to.x);
  corner.rebounds = step.image.rebounds;
  corner.placed = step.image.placed;
  corner.slowest = step.image.slowest;
  trace_.rebounds = std::max(trace_.rebounds, step.image.rebounds);
  trace_.corners.push_back(std::move(corner));
  trace_.states.emplace(static_cast<long long>(trace_.corners.size()) - 1, std::move(step.image.strobe));
}

// Marks between the last orbit and the next one, solved from between them.
void StepFollower::mark_up_to(const Point& next) {
  for (const double mark : limits_.branch.marks) {
    const double share = (mark - now_.parameter) / (next.parameter - now_.parameter);
    if (!(share >= 0) || share > 1) continue;
    const ShotOrbit at = shoot(*map_, now_.x + share * (next.x - now_.x), mark, clock_, limits_.tolerance);
    if (!at.found) continue;
    const double arc = trace_.corners.back().arc + secant_to({at.x, mark}).second;
    const bool known = !trace_.marks.empty() && trace_.marks.back().parameter == mark &&
                       std::abs(trace_.marks.back().arc - arc) <= smallest_step * arc;
    if (known) continue;
    FollowedMap::Image made = map_->march(at.x, mark, clock_, true);
    std::vector<std::complex<double>> multipliers = multipliers_of(made.derivative);
    const Outside beyond = outside(multipliers);
    trace_.marks.push_back({mark, arc, made.tip, pieces() - 1, std::move(made.strobe),
                            limits_.branch.leading(std::move(multipliers)), beyond});
  }
}

// Ends the branch at the end of the range that a point is beyond, where it goes there.
bool StepFollower::reaches_end(const Point& beyond) {
  const double limit = beyond.parameter < limits_.branch.least ? limits_.branch.least : limits_.branch.largest;
  const double share = (limit - now_.parameter) / (beyond.parameter - now_.parameter);
  const ShotOrbit at = shoot(*map_, now_.x + share * (beyond.x - now_.x), limit, clock_, limits_.tolerance);
  failure_ = fmt::format("no orbit of the branch was found at {:.10g}", limit);
  if (!at.found) return false;
  const Point end{at.x, limit};
  const auto [secant, far] = secant_to(end);
  if (far > step_ * growth || overlap(secant, along_) < sharpest) return false;
  along_ = secant;
  trace_.corners.back().way = along_.parameter < 0 ? -1 : 1;
  mark_up_to(end);
  keep({end, map_->march(at.x, limit, clock_, true)});
  trace_.end_by(TraceEnd::range, fmt::format("the range ends at {:.10g}", limit));
  return true;
}

// Whether the first orbit lies on the step to the next one, which goes the same way.
bool StepFollower::comes_back(const Point& secant, double far) const {
  constexpr std::size_t fewest = 8;
  constexpr double aside = 0.05;  // of the step
  if (trace_.corners.size() < fewest || trace_.corners.front().way != trace_.corners.back().way) return false;
  const Point back{first_ - now_.x, trace_.corners.front().parameter - now_.parameter};
  const double along = overlap(back, secant), length = std::sqrt(overlap(back, back));
  return along >= 0 && along <= far && std::sqrt(std::max(0.0, length * length - along * along)) < aside * far;
}

// Whether an orbit lies back along the branch: the bordered determinant changes its sign. It does so beyond a sharp
// corner of a smooth map too, where the direction is set anew. Of such a map λ must turn, and det(1 − P') keep its
// sign.
bool StepFollower::goes_back(const Step& step) const {
  if (step.image.rebounds != 0) return false;
  if (!limits_.smooth) return step.turned * orientation_ < 0;
  return (step.to.parameter - now_.parameter) * along_.parameter < 0 &&
         outside(step.multipliers).side() == trace_.corners.back().raw.outside.side();
}

// Solves the orbit a step along, and says whether the step is taken. One beyond the range is not solved.
StepFollower::Verdict StepFollower::judge(Step& step) {
  step.to = {now_.x + step_ * along_.x, now_.parameter + step_ * along_.parameter};
  if (!within(step.to)) return Verdict::taken;
  if (!correct(step, along_)) return Verdict::failed;
  step.multipliers = multipliers_of(step.image.derivative);
  if (goes_back(step)) {
    failure_ = "the next orbit goes back along the branch";
    return Verdict::failed;
  }
  const auto [secant, far] = secant_to(step.to);
  const double cosine = overlap(secant, along_);
  // Nearer than impacts are placed neither directions nor multipliers say anything.
  const BranchCorner& last = trace_.corners.back();
  const double told = unresolved * step.image.rebounds;
  if (far > std::max(most_steps * step_, unresolved * last.rebounds)) {
    failure_ = "the next orbit is farther than a step";
    return Verdict::failed;
  }
  if (cosine < sharpest && !(far < told && cosine > 0)) {
    failure_ = "the branch turns by more than 45 degrees within a step";
    return Verdict::failed;
  }
  const bool crosses =
      outside(step.multipliers).total != last.raw.outside.total || (limits_.smooth && step.image.runs != last.runs);
  return crosses && step_ > std::max(limits_.located * range(), told) ? Verdict::crosses : Verdict::taken;
}

std::string StepFollower::why_left(const Step& tried) const {
  if (trace_.grazes())
    return fmt::format("an impact becomes a graze, where the derivative is infinite; ended at λ = {:.10g}, {:.3g} m/s",
                       now_.parameter, trace_.corners.back().slowest);
  return fmt::format("the branch was left at λ = {:.10g}: {}step below {:.3g} m; {}", now_.parameter,
                     tried.jumps ? "no orbit was found beyond a contact that comes or goes; " : "",
                     smallest_step * range(), failure_);
}

// The orbit of the longest step that is taken; nothing where the branch has ended.
std::optional<StepFollower::Step> StepFollower::next_orbit() {
  // Of a smooth map: the shortest step so far that changes what is placed. No shorter one may be found where contacts
  // come or go that the map does not resolve.
  std::optional<Step> across;
  const double located = limits_.located * range();
  Step step;
  for (;; step_ *= 0.5) {
    step.jumps = limits_.smooth && step_ < 0.01 * located;
    if (step.jumps && across) {
      step.to = across->to;
      step.image = across->image;
    }
    if (step.jumps && (across || pass_graze(step))) {
      step.multipliers = multipliers_of(step.image.derivative);
      step_ = located;
      return step;
    }
    if (step_ < smallest_step * range() && !turn_corner()) {
      trace_.end_by(TraceEnd::left, why_left(step));
      return std::nullopt;
    }
    const Verdict verdict = judge(step);
    if (verdict == Verdict::crosses && limits_.smooth && within(step.to)) across = step;
    if (verdict != Verdict::taken) continue;
    if (within(step.to)) return step;
    if (reaches_end(step.to)) return std::nullopt;
  }
}

// The divisor of its period after which an orbit is back already; 0: none.
int StepFollower::repeats_after(const Step& step) {
  MapClock part = clock_;
  for (part.period = 1; part.period < clock_.period; ++part.period) {
    if (clock_.period % part.period != 0) continue;
    part.begins = static_cast<int>(clock_.begins % part.steps());
    const auto made = image_over(step.to, part, false);
    if (made && map_->metric().size(made->image - step.to.x) <= std::max(largest_round_off, 2 * step.image.placed))
      return part.period;
  }
  return 0;
}

// From here on x stands elsewhere in the period.
void StepFollower::stand(const Point& before, int begins) {
  const Point last{map_->moved(before.x, before.parameter, clock_, begins), before.parameter};
  now_.x = map_->moved(now_.x, now_.parameter, clock_, begins);
  clock_.begins = begins;
  first_ = first_orbit();
  const auto [secant, far] = secant_to(last);
  along_ = {-secant.x, -secant.parameter};
  if (limits_.branch.ends_at_image) apart_ = asymmetry(now_);
}

VectorXd StepFollower::first_orbit() const {
  MapClock strobe = clock_;
  strobe.begins = 0;
  return map_->moved(trace_.states.at(0), trace_.corners.front().parameter, strobe, clock_.begins);
}

// Goes to the next orbit.
void StepFollower::take(Step step) {
  const auto [secant, far] = secant_to(step.to);
  const VectorXd apart = apart_.size() > 0 ? std::exchange(apart_, asymmetry(step.to)) : VectorXd();
  if (apart_.dot(apart) < 0)
    trace_.end_at_image(step.to.parameter);
  else
    mark_up_to(step.to);
  if (const int sooner = limits_.branch.ends_sooner ? repeats_after(step) : 0; sooner > 0)
    trace_.end_at_repeat(sooner, step.to.parameter);
  if (!trace_.ended() && comes_back(secant, far))
    trace_.end_by(TraceEnd::closed, "closed: the branch came back to its first orbit");
  if (trace_.ended()) return;
  const BranchCorner& last = trace_.corners.back();
  const int side = outside(step.multipliers).side();
  const bool contact = step.image.runs != last.runs;
  // A secant over a turn, a corner or a jump is no direction of the branch.
  const bool anew = limits_.smooth && (step.jumps || contact || side != last.raw.outside.side());
  if (limits_.smooth && contact) place_contact(step);
  along_ = secant;
  // The secant that ends here is that of the corner before.
  trace_.corners.back().way = step.to.parameter < now_.parameter ? -1 : 1;
  keep(step);
  const Point before = std::exchange(now_, std::move(step.to));
  if (step.image.quiet != clock_.begins) stand(before, step.image.quiet);
  if (anew && !set_tangent(orientation_ * side, step.image.derivative)) return;
  if (step.iterations <= easy) step_ = std::min(growth * step_, largest_step * range());
  if (step.iterations > hard) step_ /= growth;
  if (pieces() > limits_.branch.pieces)
    trace_.end_by(TraceEnd::limit, fmt::format("{} steps, the most of at_most", limits_.branch.pieces));
  else if (trace_.corners.back().arc >= limits_.branch.arc)
    trace_.end_at_arc(limits_.branch.arc);
}

bool StepFollower::advance(long long steps) {
  for (; steps > 0 && !trace_.ended(); --steps)
    if (auto step = next_orbit()) take(std::move(*step));
  return !trace_.ended();
}

}  // namespace ricochet
