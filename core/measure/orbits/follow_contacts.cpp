#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/shoot.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

// Steps of arclength over contacts that come or go, and over corners.
namespace ricochet {

using Eigen::Index;
using Eigen::VectorXd;

// Of a map without steps of time, where no shorter step finds an orbit: a contact comes or goes. The orbit beyond is
// looked for by longer steps, then with one contact more or less at the next values up and down, where the branch
// turns.
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

// Adds the orbit at which a contact comes or goes before the one beyond it: the last one along the branch on the side
// with fewer contacts, where the map has a derivative.
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

}  // namespace ricochet
