#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/shoot.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

// Steps of arclength over contacts that come or go, and over corners.
namespace ricochet {

using Eigen::Index;
using Eigen::VectorXd;

// The cosine between two directions.
double StepFollower::cosine(const Point& a, const Point& b) const {
  return overlap(a, b) / std::sqrt(overlap(a, a) * overlap(b, b));
}

// Of a map without steps of time, where no shorter step finds an orbit: a contact comes or goes. The orbit beyond is
// looked for by longer steps, then with one contact more or less at the next values up and down, where the branch
// turns.
bool StepFollower::pass_graze(Point& next) {
  const double range = limits_.branch.largest - limits_.branch.least, metres = map_->metric().parameter_metres();
  int iterations = 0;
  for (double step = limits_.located * metres * range; step < largest_step * metres * range; step *= 2) try {
      next = {now_.x + step * along_.x, now_.parameter + step * along_.parameter};
      if (!correct(next, along_, iterations)) continue;
      if (cosine({next.x - now_.x, next.parameter - now_.parameter}, along_) >= sharpest) return true;
    } catch (const Refusal&) {  // no state there
    }
  constexpr double nearest = 1e-8, farthest = 1.1e-4, decade = 10, near = 100;
  for (double by = nearest * range; by < farthest * range; by *= decade)
    for (const int side : {along_.parameter < 0 ? -1 : 1, along_.parameter < 0 ? 1 : -1}) try {
        const double value = now_.parameter + side * by;
        const ShotOrbit shot = shoot(*map_, now_.x, value, clock_, limits_.tolerance);
        if (!shot.found || !(map_->metric().size(shot.x - now_.x) < near * metres * by)) continue;
        last_ = map_->march(shot.x, value, clock_, true);
        if (last_.runs == trace_.corners.back().runs) continue;
        next = {shot.x, value};
        return true;
      } catch (const Refusal&) {  // no state there
      }
  return false;
}

// Adds the orbit at which a contact comes or goes before the one beyond it: the last one along the branch on the side
// with fewer contacts, where the map has a derivative. `along`: the direction before.
void StepFollower::place_contact(const Point& beyond, const Point& along, bool turns) {
  const FollowedMap::Image there = last_;
  const bool vanishes = there.runs < trace_.corners.back().runs;
  const int runs = std::min(there.runs, trace_.corners.back().runs);
  const double range = map_->metric().parameter_metres() * (limits_.branch.largest - limits_.branch.least);
  double low = 0, high = map_->metric().size(beyond.x - now_.x, beyond.parameter - now_.parameter);
  Point direction = along;
  if (vanishes) {
    const auto back = tangent(beyond, there.derivative);
    if (!back) return;
    const int way = turns == (along.parameter > 0) ? 1 : -1;
    direction = {way * back->x, way * back->parameter};
    constexpr int over = 4;  // a jump leads beyond the contact
    high *= over;
  }
  const Point& from = vanishes ? beyond : now_;
  Point found;
  FollowedMap::Image image;
  while (high - low > smallest_step * range) {
    const double step = 0.5 * (low + high);
    Point point{from.x + step * direction.x, from.parameter + step * direction.parameter};
    int iterations = 0;
    bool before = false;
    try {
      before = correct(point, direction, iterations) && last_.runs == runs;
    } catch (const Refusal&) {  // no state there
    }
    (before ? low : high) = step;
    if (!before) continue;
    found = std::move(point);
    image = last_;
  }
  last_ = there;
  if (low == 0) return;
  trace_.corners.back().way = found.parameter < now_.parameter ? -1 : 1;
  keep(found, image, multipliers_of(image.derivative));
  now_ = std::move(found);
}

// Takes the null direction beyond a corner that the last orbit is next to. The determinant bordered by the direction
// of the branch keeps its sign there.
bool StepFollower::turn_corner() {
  const double range = map_->metric().parameter_metres() * (limits_.branch.largest - limits_.branch.least);
  constexpr double beyond = 1e-6, difference = 1e-7, step = 1e-5;  // of the range
  if (trace_.rebounds > 0 || orientation_ == 0 || trace_.corners.back().arc == corner_) return false;
  corner_ = trace_.corners.back().arc;
  const Point there{now_.x + beyond * range * along_.x, now_.parameter + beyond * range * along_.parameter};
  try {
    last_ = map_->march(there.x, there.parameter, clock_, true);
  } catch (const Refusal& refusal) {
    failure_ = refusal.sentence;
    return false;
  }
  if (last_.end) return false;
  const Index D = map_->size();
  const VectorXd slope = by_parameter(there, difference);
  const VectorXd found = DenseLu(bordered(last_.derivative, slope, along_)).solve(VectorXd::Unit(D + 1, D));
  Point along{found.head(D), found[D]};
  const double size = map_->metric().size(along.x, along.parameter);
  if (!std::isfinite(size) || size == 0) return false;
  const double sign = determinant(bordered(last_.derivative, slope, along)) * orientation_ < 0 ? -1 : 1;
  along_ = {sign / size * along.x, sign / size * along.parameter};
  step_ = step * range;
  return true;
}

}  // namespace ricochet
