#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <utility>

namespace ricochet {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ShotOrbit shoot(PeriodicMap& map, VectorXd x, double parameter, const MapClock& clock, double tolerance, int most) {
  ShotOrbit orbit;
  orbit.parameter = parameter;
  orbit.nearest = std::numeric_limits<double>::infinity();
  SetSequence before;
  const MatrixXd one = MatrixXd::Identity(map.size(), map.size());
  for (;; ++orbit.iterations) {
    MapMarch made = map.march(x, parameter, clock);
    orbit.end = made.end;
    if (made.end) break;
    const VectorXd left = made.image - x;
    const double last = std::exchange(orbit.residual, map.metric().size(left));
    orbit.nearest = std::min(orbit.nearest, orbit.residual);
    before = std::exchange(orbit.sets, std::move(made.sets));
    // With the sets of an orbit one iteration is exact: what a second one leaves is round-off.
    const bool settled = orbit.iterations > 1 && before == orbit.sets && orbit.residual < largest_round_off;
    orbit.found = orbit.residual <= std::min(tolerance, largest_residual) || (settled && orbit.residual > 0.1 * last);
    if (orbit.found || orbit.iterations == most || !std::isfinite(orbit.residual)) break;
    const VectorXd correction = DenseLu(one - map.derivative(orbit.sets, clock)).solve(left);
    if (!correction.allFinite()) break;
    x += correction;
  }
  orbit.x = std::move(x);
  for (std::size_t k = 0; !orbit.found && k < before.size() && orbit.step < 0; ++k) {
    if (before[k] == orbit.sets[k]) continue;
    orbit.step = static_cast<long long>(k);
    const std::vector<int>&was = map.sets()[before[k]].side, &is = map.sets()[orbit.sets[k]].side;
    orbit.row = static_cast<int>(std::mismatch(was.begin(), was.end(), is.begin()).first - was.begin());
  }
  return orbit;
}

std::optional<VectorXd> free_orbit(PeriodicMap& map, double parameter, const MapClock& clock) {
  const SetSequence open(static_cast<std::size_t>(clock.steps()), 0);
  std::vector<PeriodicMap::Column> column = {{VectorXd::Zero(map.size()), parameter, false}};
  map.sweep(open, clock, column);
  const MatrixXd one = MatrixXd::Identity(map.size(), map.size());
  const VectorXd x = DenseLu(one - map.derivative(open, clock)).solve(column.front().x);
  if (!x.allFinite()) return std::nullopt;
  return x;
}

VectorXd one_unit_on(VectorXd x) {
  for (double& number : x)
    if (number != 0) number = std::nextafter(number, std::numeric_limits<double>::infinity());
  return x;
}

double round_off_of_map(PeriodicMap& map, const VectorXd& x, double parameter, const MapClock& clock) {
  const VectorXd first = map.march(x, parameter, clock).image,
                 second = map.march(one_unit_on(x), parameter, clock).image;
  return std::max(map.metric().size(second - first), std::numeric_limits<double>::epsilon() * map.metric().size(x));
}

using Eigen::Index;

LaneSpec AffineLane::lane(double parameter) const {
  LaneSpec spec = origin;
  const double by = parameter - at;
  spec.amplitude += by * amplitude;
  spec.lower += by * lower;
  spec.upper += by * upper;
  return spec;
}

std::optional<AffineLane> affine_lane(const LaneSpec& first, double at_first, const LaneSpec& second,
                                      double at_second) {
  if (first.phase != second.phase || first.law.values() != second.law.values()) return std::nullopt;
  if (first.lower.size() != second.lower.size()) return std::nullopt;
  const double by = at_second - at_first;
  const auto slope = [&](double a, double b) { return a == b ? 0.0 : (b - a) / by; };
  AffineLane affine{first, at_first, slope(first.amplitude, second.amplitude), first.lower, first.upper};
  for (Index i = 0; i < first.lower.size(); ++i) {
    affine.lower[i] = slope(first.lower[i], second.lower[i]);
    affine.upper[i] = slope(first.upper[i], second.upper[i]);
  }
  if (!affine.lower.allFinite() || !affine.upper.allFinite()) return std::nullopt;
  return affine;
}

bool passes_through(const AffineLane& affine, const LaneSpec& lane, double at) {
  constexpr double round_off = 1e-12;
  const LaneSpec found = affine.lane(at);
  const auto same = [&](double a, double b) { return a == b || std::abs(a - b) <= round_off * std::abs(b); };
  if (lane.phase != found.phase || lane.law.values() != found.law.values() || !same(found.amplitude, lane.amplitude))
    return false;
  for (Index i = 0; i < lane.lower.size(); ++i)
    if (!same(found.lower[i], lane.lower[i]) || !same(found.upper[i], lane.upper[i])) return false;
  return true;
}

}  // namespace ricochet
