#pragma once
#include <ricochet/measure/orbits/shoot.hpp>
#include <string>

#include "runners/kinds/continuation/continued_map.hpp"

namespace ricochet {

/// Of the gap: an orbit this near to its own image is solved as one.
inline constexpr double image_tolerance = 1e-6;

/// An orbit that branches begin with, or why there is none.
struct FirstOrbit {
  ShotOrbit shot;
  MapClock clock;
  std::string why;  ///< "" where it was found
};

/// Solves a wanted orbit by Newton's method: from the motion without contact, from a stored orbit, or from a transient.
/// Where that did not settle, states after 3, 10, 30 and 100 periods are tried, which pass near to orbits. An orbit
/// that is its own image is solved by half its period; one that repeats sooner than wanted is none. `round_off`: the
/// largest of the map so far, m. Map: PeriodicMap or SteppedMap.
template <class Map>
FirstOrbit first_orbit(ContinuedMap& continued, Map& map, int steps_per_period, const WantedOrbit& orbit,
                       double& round_off);

}  // namespace ricochet
