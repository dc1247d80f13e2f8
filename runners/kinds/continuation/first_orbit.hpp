#pragma once
#include <functional>
#include <ricochet/measure/orbits/periodic_map.hpp>
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

/// What a search for an orbit asks of those who have its map.
struct OrbitStarts {
  int steps_per_period = 0;  ///< 0: a map without steps
  double gap = 1;            ///< m
  std::string no_image;      ///< why orbits are not their own images; "" where they may be
  /// Where Newton's method begins, of a transient after so many periods. Throws Refusal where there is no such state.
  std::function<Eigen::VectorXd(int periods, const MapClock& clock)> state;
  std::function<double(const Eigen::VectorXd& x, const MapClock& clock)> tolerance;  ///< of residuals, m
};

/// Solves a wanted orbit by Newton's method: from the motion without contact, from a stored orbit, or from a transient.
/// Where that did not settle, states after 3, 10, 30 and 100 periods are tried, which pass near to orbits. An orbit
/// that is its own image is solved by half its period; one that repeats sooner than wanted is none. Map: PeriodicMap,
/// SteppedMap or ReferenceOrbits.
template <class Map>
FirstOrbit first_orbit(Map& map, const OrbitStarts& starts, const WantedOrbit& orbit);
/// The same of a method. `round_off`: the largest of the map so far, m.
template <class Map>
FirstOrbit first_orbit(ContinuedMap& continued, Map& map, int steps_per_period, const WantedOrbit& orbit,
                       double& round_off);

}  // namespace ricochet
