#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/impact_jump.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <ricochet/measure/orbits/section_march.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <utility>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Runs of contact of one lane, and the speeds that they change.
class ContactWatch final : public StepObserver {
 public:
  explicit ContactWatch(const Marcher& marcher)
      : points_(marcher.program().contact ? static_cast<std::size_t>(marcher.program().problem->points()) : 0),
        now_(points_) {}
  void stage_solved(const Marcher& marcher, const StageView& view) override {
    if (view.contact_lanes == 0) return;
    for (const int point : view.pushed)
      if (const double p = view.effort[0][static_cast<std::ptrdiff_t>(point) * marcher.width()]; p != 0)
        now_[static_cast<std::size_t>(point)] = p > 0 ? -1 : 1;
  }
  void step_done(Marcher& marcher) override {
    if (points_ == 0) return;
    const RowMatrix& rows = marcher.program().model->contact();
    const double* const q = marcher.slot(0);
    for (int i = 0; i < rows.rows(); ++i) {
      double y = marcher.lift(0, i, marcher.time());
      const auto row = static_cast<std::size_t>(i);
      for (auto e = static_cast<std::size_t>(rows.start[row]); e < static_cast<std::size_t>(rows.start[row + 1]); ++e)
        y += rows.value[e] * q[static_cast<std::ptrdiff_t>(rows.index[e]) * marcher.width()];
      places_.push_back(y);
    }
    const bool closed = std::any_of(now_.begin(), now_.end(), [](int side) { return side != 0; });
    sides_.insert(sides_.end(), now_.begin(), now_.end());
    std::fill(now_.begin(), now_.end(), 0);
    if (closed) deepest = std::max(deepest, marcher.penetration(0));
  }
  /// Of the whole march.
  void sum(double h, bool half, SteppedMap::Image& out) const {
    const auto n = static_cast<long long>(steps());
    ContactRuns runs;
    for (std::size_t point = 0; point < points_; ++point) {
      const auto at = [&](long long step) { return static_cast<std::size_t>(step) * points_ + point; };
      const auto run = [&](long long begin, long long length) {
        runs.add(length, half ? 2 * n : n);
        const long long end = begin + length;
        if (begin < 2 || end + 1 >= n || length > briefest_contact) return;
        const double before = places_[at(begin - 1)] - places_[at(begin - 2)],
                     after = places_[at(end + 1)] - places_[at(end)];
        if (!(before * after < 0)) return;
        out.rebounds += std::abs(after - before);  // h |v⁺ − v⁻|
        const double speed = std::abs(before) / h;
        out.slowest = out.slowest == 0 ? speed : std::min(out.slowest, speed);
      };
      each_run(
          n, half, [&](long long k) { return sides_[at(k)]; }, run);
    }
    out.pace = pace(h);
    out.placed = out.rebounds * std::min(1.0, h * out.pace);
    out.runs = runs.count;
    out.held = runs.held;
    out.shortest = runs.shortest;
    out.penetration = deepest;
  }
  /// Steps from where x stands to the middle of the longest time without contact; 0 where no contact is near, or that
  /// middle is hardly farther from one.
  long long to_quiet(bool half, int steps_per_period) const {
    const auto n = static_cast<long long>(steps());
    constexpr long long before = 2, after = 4;  // steps of an impact beside its contact
    std::vector<std::pair<long long, long long>> busy;
    for (std::size_t point = 0; point < points_; ++point)
      each_run(
          n, half, [&](long long k) { return sides_[static_cast<std::size_t>(k) * points_ + point]; },
          [&](long long begin, long long length) { busy.emplace_back(begin - before, begin + length + after); });
    if (busy.empty()) return 0;
    std::sort(busy.begin(), busy.end());
    // Round the period, from the end of the first contact on.
    long long end = busy.front().second, longest = 0, middle = 0, nearest = n;
    for (std::size_t k = 1; k <= busy.size(); ++k) {
      const auto [from, to] = k < busy.size() ? busy[k] : std::pair(busy.front().first + n, busy.front().second + n);
      if (from - end > longest) longest = from - end, middle = end + longest / 2;
      // The next time that x stands between both, or within a contact.
      for (const long long at : {0LL, n})
        if (at >= end && at < from) nearest = std::min(at - end, from - at);
      end = std::max(end, to);
    }
    const bool free = nearest < n;
    constexpr int part = 16, share = 4;
    if (longest == 0 || (free && nearest >= std::min<long long>(steps_per_period / part, longest / share))) return 0;
    return middle % n;
  }
  double deepest = 0;

 private:
  std::size_t steps() const { return points_ > 0 ? places_.size() / points_ : 0; }
  double pace(double h) const {
    if (steps() < 2) return 0;
    double way = 0, far = 0;
    for (std::size_t point = 0; point < points_; ++point) {
      double mean = 0;
      for (std::size_t at = point; at < places_.size(); at += points_) mean += places_[at];
      mean /= static_cast<double>(steps());
      for (std::size_t at = point + points_; at < places_.size(); at += points_) {
        way += std::pow(places_[at] - places_[at - points_], 2);
        far += std::pow(places_[at] - mean, 2);
      }
    }
    return far > 0 ? std::sqrt(way / far) / h : 0;
  }

  std::size_t points_;
  std::vector<int> now_;
  std::vector<double> places_;  // points of each step, one step after the other
  std::vector<int> sides_;      // likewise
};

}  // namespace

SteppedMap::SteppedMap(Make make, Carry carry, double at, const ArcUnits& units, bool rebounds)
    : make_(std::move(make)), carry_(std::move(carry)), rebounds_(rebounds) {
  Scene scene = make_(at, 0);
  if (scene.program.contact && scene.program.law->memory_per_point() > 0)
    throw Refusal{"a law that keeps a memory has no derivative of it"};
  group_ = scene.group;
  vector_ = std::make_unique<StateVector>(scene.program);
  metric_ = std::make_unique<StateMetric>(scene.program, size(), units);
  reference_ = std::make_unique<Program>(make_(at, 0).program);
  template_ = Marcher(std::move(scene.program)).lane_state(0);
}

VectorXd SteppedMap::read(const LaneState& state, int group) const {
  return vector_->read(carry_(state, group, group_));
}

LaneState SteppedMap::unit(int k) const {
  LaneState state = template_;
  std::fill(state.slots.begin(), state.slots.end(), 0.0);
  std::fill(state.efforts.begin(), state.efforts.end(), 0.0);
  std::fill(state.memory.begin(), state.memory.end(), 0.0);
  vector_->write(VectorXd::Unit(size(), k), state);
  return state;
}

std::pair<Marcher, int> SteppedMap::begin(const VectorXd& x, double parameter, int tangents, int begins) const {
  Scene scene = make_(parameter, tangents);
  Marcher marcher(std::move(scene.program));
  LaneState state = template_;
  vector_->write(x, state);
  marcher.set_clock(begins);
  LaneSpec lane = marcher.program().lanes[0];
  if (open_) {
    lane.lower.setConstant(-std::numeric_limits<double>::infinity());
    lane.upper.setConstant(std::numeric_limits<double>::infinity());
  }
  marcher.set_lane(0, std::move(lane), carry_(state, group_, scene.group));
  return {std::move(marcher), scene.group};
}

SteppedMap::Image SteppedMap::march(const VectorXd& x, double parameter, const MapClock& clock, bool derivative) {
  Image out;
  if (derivative) out.derivative.resize(size(), size());
  for (int first = 0; first == 0 || (derivative && first < size()); first += most_tangents) {
    const int columns = derivative ? std::min(most_tangents, size() - first) : 0;
    auto [marcher, group] = begin(x, parameter, columns, clock.begins);
    for (int k = 0; k < columns; ++k) marcher.set_tangent(0, k, carry_(unit(first + k), group_, group));
    std::optional<ImpactJump> jump;
    if (rebounds_) jump.emplace(marcher, ImpactJump::Orbit::placed);
    ContactWatch watch(marcher);
    Observers observers;
    if (first == 0) observers.add(&watch);
    if (jump && jump->needed()) observers.add(&*jump);
    StrobeTip tip;
    // A half map may begin in either half.
    const long long into = clock.begins % clock.steps();
    const double turned = clock.begins < clock.steps() ? 1 : clock.sign();
    if (into == 0) {
      tip = march_over(marcher, clock, observers);
      tip.displacement *= turned;
      tip.velocity *= turned;
    } else {
      marcher.march(clock.steps() - into - 1, observers);
      const double before = marcher.tip(0);
      marcher.march(1, observers);
      tip.displacement = turned * clock.sign() * marcher.tip(0);
      if (first == 0) out.strobe = turned * clock.sign() * read(marcher.lane_state(0), group);
      marcher.march(1, observers);
      tip.velocity = turned * clock.sign() * (marcher.tip(0) - before) / (2 * marcher.program().h);
      marcher.march(into - 1, observers);
    }
    out.tip = tip.displacement;
    out.tip_velocity = tip.velocity;
    out.end = marcher.status(0).end;
    if (out.end) return out;
    if (first == 0) {
      out.image = clock.sign() * read(marcher.lane_state(0), group);
      if (into == 0) out.strobe = turned * x;
      watch.sum(marcher.program().h, clock.half, out);
      out.quiet = clock.begins;
      if (rebounds_)
        out.quiet =
            static_cast<int>((clock.begins + watch.to_quiet(clock.half, clock.steps_per_period)) % clock.steps());
      else
        out.rebounds = out.placed = out.slowest = 0;
    }
    for (int k = 0; k < columns; ++k) out.derivative.col(first + k) = clock.sign() * read(marcher.tangent(0, k), group);
    out.untold = out.untold || (jump && jump->untold(0) > 0);
  }
  return out;
}

VectorXd SteppedMap::moved(const VectorXd& x, double parameter, const MapClock& clock, int begins) {
  if (begins == clock.begins) return x;
  auto [marcher, group] = begin(x, parameter, 0, clock.begins);
  std::optional<ImpactJump> jump;
  if (rebounds_) jump.emplace(marcher, ImpactJump::Orbit::placed);
  Observers observers;
  if (jump && jump->needed()) observers.add(&*jump);
  const bool round = begins < clock.begins;
  marcher.march(begins - clock.begins + (round ? clock.steps() : 0), observers);
  return (round ? clock.sign() : 1) * read(marcher.lane_state(0), group);
}

QuietOrbit quiet_orbit(FollowedMap& map, const VectorXd& x, double parameter, const MapClock& clock) {
  QuietOrbit out{x, clock};
  const FollowedMap::Image made = map.march(x, parameter, clock);
  if (made.end) return out;
  out.clock.begins = made.quiet;
  out.x = map.moved(x, parameter, clock, made.quiet);
  return out;
}

FollowedMap::Image march_quiet(FollowedMap& map, QuietOrbit& at, double parameter) {
  FollowedMap::Image made = map.march(at.x, parameter, at.clock, true);
  if (made.end || made.quiet == at.clock.begins) return made;
  at.x = map.moved(at.x, parameter, at.clock, made.quiet);
  at.clock.begins = made.quiet;
  return map.march(at.x, parameter, at.clock, true);
}

ShotOrbit shoot(FollowedMap& map, VectorXd x, double parameter, const MapClock& told, double tolerance, int most) {
  ShotOrbit orbit;
  orbit.parameter = parameter;
  orbit.nearest = std::numeric_limits<double>::infinity();
  const MatrixXd one = MatrixXd::Identity(map.size(), map.size());
  QuietOrbit at{std::move(x), told}, best = at;
  for (;; ++orbit.iterations) {
    const FollowedMap::Image made = march_quiet(map, at, parameter);
    orbit.end = made.end;
    if (made.end) break;
    const VectorXd left = made.image - at.x;
    const double last = std::exchange(orbit.residual, map.metric().size(left));
    if (orbit.residual < orbit.nearest) {
      orbit.nearest = orbit.residual;
      best = at;
    }
    // Where an iteration gains nothing any more the rest is round-off.
    const bool settled = orbit.iterations > 1 && orbit.residual < stalled * tolerance && orbit.residual > 0.1 * last;
    orbit.found = settled || orbit.residual <= std::max(tolerance, made.placed);
    if (settled || orbit.residual <= tolerance || orbit.iterations == most || !std::isfinite(orbit.residual)) break;
    // What gives back speed is not solved more nearly than its impacts are placed: two more iterations are tried.
    if (orbit.found && orbit.iterations > 2 && orbit.residual > 0.5 * orbit.nearest) break;
    const VectorXd correction = DenseLu(one - made.derivative).solve(left);
    if (!correction.allFinite()) break;
    at.x += correction;
  }
  if (!orbit.found) best = std::move(at);
  orbit.x = map.moved(best.x, parameter, best.clock, told.begins);
  orbit.residual = orbit.nearest;
  return orbit;
}

std::optional<VectorXd> free_orbit(SteppedMap& map, double parameter, const MapClock& clock) {
  map.without_stops(true);
  const VectorXd rest = VectorXd::Zero(map.size());
  const SteppedMap::Image made = map.march(rest, parameter, clock, true);
  map.without_stops(false);
  if (made.end) return std::nullopt;
  const VectorXd x = DenseLu(MatrixXd::Identity(map.size(), map.size()) - made.derivative).solve(made.image);
  if (!x.allFinite()) return std::nullopt;
  return x;
}

double round_off_of_map(SteppedMap& map, const VectorXd& x, double parameter, const MapClock& clock) {
  const QuietOrbit at = quiet_orbit(map, x, parameter, clock);
  const double apart = map.metric().size(map.march(at.x, parameter, at.clock).image -
                                         map.march(one_unit_on(at.x), parameter, at.clock).image);
  const double steps = std::sqrt(static_cast<double>(clock.steps()));
  return std::max(apart, steps * std::numeric_limits<double>::epsilon() * map.metric().size(at.x));
}

// Steps of arclength over contacts that come or go, and over corners.

// Of a map without steps of time, where no shorter step finds an orbit: a contact comes or goes. The orbit beyond is
// looked for by longer steps. Where the branch turns there is none: it is then looked for at the next values up and
// down, with another count of contacts.
bool StepFollower::pass_graze(Step& step) {
  const double range = limits_.branch.largest - limits_.branch.least, metres = map_->metric().parameter_metres();
  const std::string failure = failure_;  // of the step itself
  Step tried;
  for (double far = limits_.located * metres * range; far < largest_step * metres * range; far *= 2) {
    tried.to = {now_.x + far * along_.x, now_.parameter + far * along_.parameter};
    if (!correct(tried, along_) || !within(tried.to)) continue;
    if (overlap(secant_to(tried.to).first, along_) < sharpest) continue;
    step.to = std::move(tried.to);
    step.image = std::move(tried.image);
    return true;
  }
  constexpr double nearest = 1e-8, farthest = 1.1e-4, decade = 10, near = 100;
  for (double by = nearest * range; by < farthest * range; by *= decade)
    for (const int side : {along_.parameter < 0 ? -1 : 1, along_.parameter < 0 ? 1 : -1}) try {
        const double value = now_.parameter + side * by;
        const ShotOrbit shot = shoot(*map_, now_.x, value, clock_, limits_.tolerance);
        if (!shot.found || !(map_->metric().size(shot.x - now_.x) < near * metres * by)) continue;
        step.image = map_->march(shot.x, value, clock_, true);
        if (step.image.runs == trace_.corners.back().runs) continue;
        step.to = {shot.x, value};
        return true;
      } catch (const Refusal&) {  // no state there
      }
  failure_ = failure;
  return false;
}

// Adds the orbit at which a contact comes or goes before the one beyond it. It is the last one on the side with fewer
// contacts, where the map has a derivative.
void StepFollower::place_contact(const Step& beyond) {
  const bool vanishes = beyond.image.runs < trace_.corners.back().runs;
  const int runs = std::min(beyond.image.runs, trace_.corners.back().runs);
  double low = 0, high = secant_to(beyond.to).second;
  Point direction = along_;
  if (vanishes) {
    const auto back = tangent(beyond.to, beyond.image.derivative);
    if (!back) return;
    const int way = -orientation_ * outside(beyond.multipliers).side();
    direction = {way * back->x, way * back->parameter};
    constexpr int over = 4;  // a jump leads beyond the contact
    high *= over;
  }
  const Point& from = vanishes ? beyond.to : now_;
  Step found;
  while (high - low > smallest_step * range()) {
    const double step = 0.5 * (low + high);
    Step tried{{from.x + step * direction.x, from.parameter + step * direction.parameter}};
    const bool before = correct(tried, direction) && tried.image.runs == runs;
    (before ? low : high) = step;
    if (before) found = std::move(tried);
  }
  if (low == 0) return;
  trace_.corners.back().way = found.to.parameter < now_.parameter ? -1 : 1;
  keep(found);
  now_ = std::move(found.to);
}

// Takes the null direction beyond a corner that the last orbit is next to. The determinant bordered by the direction
// of the branch keeps its sign there.
bool StepFollower::turn_corner() {
  constexpr double beyond = 1e-6, difference = 1e-7, step = 1e-5;  // of the range
  if (limits_.smooth || trace_.rebounds > 0 || trace_.corners.back().arc == corner_) return false;
  corner_ = trace_.corners.back().arc;
  const Point there{now_.x + beyond * range() * along_.x, now_.parameter + beyond * range() * along_.parameter};
  const auto made = image_of(there, true);
  if (!made) return false;
  const Index D = map_->size();
  const VectorXd slope = by_parameter(there, difference);
  const VectorXd found = DenseLu(bordered(made->derivative, slope, along_)).solve(VectorXd::Unit(D + 1, D));
  Point along{found.head(D), found[D]};
  const double size = map_->metric().size(along.x, along.parameter);
  if (!std::isfinite(size) || size == 0) return false;
  const double sign = determinant(bordered(made->derivative, slope, along)) * orientation_ < 0 ? -1 : 1;
  along_ = {sign / size * along.x, sign / size * along.parameter};
  step_ = step * range();
  return true;
}

ReferenceOrbits::ReferenceOrbits(Make make, double at, double parameter_metres)
    : make_(std::move(make)), scene_(make_(at)), value_(at) {
  metric_ = std::make_unique<StateMetric>(Eigen::MatrixXd(scene_.map->weights().asDiagonal()), parameter_metres);
}

ReferenceOrbits::Scene& ReferenceOrbits::at(double parameter) {
  if (parameter != value_) {
    scene_ = make_(parameter);
    value_ = parameter;
  }
  return scene_;
}

FollowedMap::Image ReferenceOrbits::march(const Eigen::VectorXd& x, double parameter, const MapClock& clock,
                                          bool derivative) {
  Scene& scene = at(parameter);
  ReferenceMap::Image made = scene.map->march(x, scene.period * clock.period / (clock.half ? 2 : 1), derivative);
  if (!made.stopped.empty()) throw Refusal{std::move(made.stopped)};
  Image out;
  out.image = clock.sign() * made.state;
  out.strobe = x;
  if (derivative) out.derivative = clock.sign() * made.derivative;
  out.runs = made.impacts;
  std::tie(out.tip, out.tip_velocity) = scene.map->tip(x);
  return out;
}

Eigen::VectorXd ReferenceOrbits::settle(double parameter, int periods) {
  Scene& scene = at(parameter);
  const Eigen::VectorXd start = scene.map->start();
  if (periods == 0) return start;
  ReferenceMap::Image made = scene.map->march(start, scene.period * periods, false);
  if (!made.stopped.empty()) throw Refusal{std::move(made.stopped)};
  return std::move(made.state);
}

}  // namespace ricochet
