#pragma once
#include <Eigen/Core>
#include <ricochet/measure/orbits/periodic_map.hpp>

namespace ricochet {

class SteppedMap;

/// How far what a scheme marches from an orbit's state is from that state after whole periods of the orbit. Nothing is
/// placed and no sign is changed: orbits that are their own images go through both halves.
struct OwnMarch {
  double displacement = 0;  ///< root mean square over nodes, m; the largest of all periods
  double velocity = 0;      ///< m/s
  LaneEnd end;              ///< none: the march went to its end
};
OwnMarch own_march(PeriodicMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock, int periods);
OwnMarch own_march(SteppedMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock, int periods);

/// Periods over which an orbit that is told is marched.
inline constexpr int told_periods = 2;

}  // namespace ricochet
