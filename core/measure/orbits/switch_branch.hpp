#pragma once
#include <functional>
#include <optional>
#include <ricochet/measure/orbits/shoot.hpp>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>

namespace ricochet {

/// An orbit of another branch, near to the point at which it begins.
struct SwitchedOrbit {
  ShotOrbit orbit;
  MapClock clock;  ///< of the whole period where symmetry is lost, of the doubled one at a flip
};

/// Looks for the branch that begins where a multiplier of an orbit passes −1: with v its vector, Newton's method on the
/// doubled map from x ± a v, a of a thousandth, three thousandths and a hundredth of `scale` (m), at one, two and four
/// widths of the point on either side of it. `x_at` solves the orbit of the branch itself near to a value. An orbit is
/// taken that the map itself does not return to within a millionth of the scale. Nothing where there is none.
template <class Map>  // PeriodicMap or SteppedMap
std::optional<SwitchedOrbit> switch_branch(Map& map, const MapClock& clock, const SpecialPoint& point, double scale,
                                           double tolerance, const std::function<ShotOrbit(double parameter)>& x_at);

/// The derivative of a map at an orbit that was solved.
Eigen::MatrixXd derivative_at(PeriodicMap& map, const ShotOrbit& orbit, const MapClock& clock);
Eigen::MatrixXd derivative_at(SteppedMap& map, const ShotOrbit& orbit, const MapClock& clock);

}  // namespace ricochet
