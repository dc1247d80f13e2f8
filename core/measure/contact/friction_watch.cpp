#include <algorithm>
#include <cmath>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/measure/contact/friction_watch.hpp>
#include <ricochet/measure/contact/stop_places.hpp>

namespace ricochet {

void FrictionTotals::add(const FrictionTotals& other) {
  time += other.time;
  held += other.held;
  changes += other.changes;
  impulse += other.impulse;
  squares += other.squares;
  peak = std::max(peak, other.peak);
  heat += other.heat;
  slipped += other.slipped;
  wear += other.wear;
  drifted += other.drifted;
}

FrictionWatch::FrictionWatch(const Marcher& marcher, const EnergyAudit& audit, const WindowParts& window)
    : audit_(audit), window_(window), h_(marcher.program().h) {
  asks_.next_shown = never;
  if (!marcher.program().friction) return;
  const SemiDiscrete& problem = *marcher.program().problem;
  const StopList stops = stop_list(problem);
  for (const RubbingPoint& one : problem.rubbing)
    points_.emplace_back().stop = stops.stop_of[static_cast<std::size_t>(one.point)];
  totals_.resize(points_.size() * static_cast<std::size_t>(window.count));
}

int FrictionWatch::number_of(int stop) const {
  const auto found = std::find_if(points_.begin(), points_.end(), [&](const Point& one) { return one.stop == stop; });
  return found == points_.end() ? -1 : static_cast<int>(found - points_.begin());
}

namespace {

// How fast a point slides before a stage, by the velocity of the scheme.
double speed_before(const Marcher& marcher, const StageView& view, const RubbingPoint& one,
                    const std::array<double, 2>& normal) {
  const MarchModel& model = *marcher.program().model;
  const std::vector<double>& weights = marcher.program().plan.velocity.slots;
  double size = 0;
  for (int k = 0; k < one.tangents(); ++k) {
    const Tangent way = tangent_of(one, k, normal);
    std::array<double, 3> speeds{};
    for (int l = 0; l < way.count; ++l) {
      double& speed = speeds[static_cast<std::size_t>(l)];
      speed = marcher.rubbed_rate(0, way.row + l, view.from);
      for (std::size_t j = 0; j < weights.size(); ++j)
        if (weights[j] != 0) speed += weights[j] * model.times(model.rubbed(), way.row + l, view.slots[j]);
    }
    size = std::hypot(size, way.of(speeds.data()));
  }
  return size;
}

}  // namespace

void FrictionWatch::stage_solved(const Marcher& marcher, const StageView& view) {
  if (!any() || !view.effort || view.program->friction_momentum == 0) return;
  const bool seen = (view.touched_lanes & 1u) != 0 && view.friction;
  if (!seen) {
    for (Point& point : points_) point.pressed = point.held = false;
    return;
  }
  const SemiDiscrete& problem = *marcher.program().problem;
  const StageFriction& found = *view.friction;
  const double momentum = view.program->friction_momentum,
               time = view.time + view.program->facts.instant * marcher.program().h;
  residual_ = std::max(residual_, found.residual[0]);
  most_turns_ = std::max(most_turns_, found.turns[0]);
  const int part = window_.of(time, 1e-6 * h_), T = marcher.width();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Point& point = points_[i];
    const RubbingPoint& one = problem.rubbing[i];
    const int number = static_cast<int>(i);
    const double normal = found.normal.at(number, 0);
    if (!(normal > 0)) {
      point.pressed = point.held = false;
      continue;
    }
    const bool held = found.sticks.at(number, 0) != 0;
    const std::array<double, 2> normal_along{found.along.at(2 * number, 0), found.along.at(2 * number + 1, 0)};
    const double slid = found.slid.at(number, 0),
                 before = point.pressed ? point.slid : speed_before(marcher, view, one, normal_along);
    const bool turned = point.pressed && point.held != held;
    if (held && !(point.pressed && point.held)) point.held_since = marcher.step();
    // A reversal of sliding may be solved as rest in one step: that is no stick.
    const bool sticks = held && (!point.pressed || point.sticks || marcher.step() > point.held_since);
    const bool changed = point.pressed && point.sticks != sticks;
    point.sticks = sticks;
    point.pressed = true;
    point.held = held;
    point.slid = slid;
    if (part < 0) continue;
    double force = 0, work = 0, way = 0;
    for (int k = 0; k < one.tangents(); ++k) {
      const Tangent along = tangent_of(one, k, normal_along);
      force = std::hypot(force, along.effort(view.effort[0] + (problem.points() + along.row) * T, T));
      way = std::hypot(way, along.of(audit_.works().friction_ways().data() + along.row));
    }
    for (int k = 0; k < one.rows; ++k) work += audit_.works().friction_works()[static_cast<std::size_t>(one.row + k)];
    FrictionTotals& totals = totals_[i * static_cast<std::size_t>(window_.count) + static_cast<std::size_t>(part)];
    const double slides = 0.5 * (before + slid);
    totals.time += momentum;
    totals.held += held ? momentum : 0.0;
    totals.changes += changed;
    totals.impulse += momentum * force;
    totals.squares += momentum * force * force;
    totals.peak = std::max(totals.peak, force);
    totals.heat -= work;
    totals.slipped += momentum * slides;
    totals.wear += momentum * normal * slides;
    totals.drifted += held && !turned && !view.starting ? way : 0.0;
  }
}

FrictionTotals FrictionWatch::totals(int stop) const {
  FrictionTotals all;
  for (int k = 0; k < window_.count; ++k) all.add(part(stop, k));
  return all;
}

const FrictionTotals& FrictionWatch::part(int stop, int part) const {
  return totals_[static_cast<std::size_t>(number_of(stop)) * static_cast<std::size_t>(window_.count) +
                 static_cast<std::size_t>(part)];
}

}  // namespace ricochet
