#pragma once
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <string>

namespace ricochet {

/// A periodic orbit as far as Newton's method came.
struct ShotOrbit {
  bool found = false;
  Eigen::VectorXd x;
  double parameter = 0;
  SetSequence sets;  ///< of the last march
  int iterations = 0;
  double residual = 0;  ///< |P(x) − x|, m
  double nearest = 0;   ///< the least residual met, m
  LaneEnd end;          ///< of a march that stopped
  /// Of residuals that alternate: a step and a row of v in which the last two contact sets differ; −1: none.
  long long step = -1;
  int row = -1;
};

/// P(x, λ) = x by Newton's method with the derivative at the contact sets of each march: exact once the sets are those
/// of the orbit. Converged where the residual is at most `tolerance`, or the sets stay and it falls no more; at most
/// `most` iterations.
ShotOrbit shoot(PeriodicMap& map, Eigen::VectorXd x, double parameter, const MapClock& clock, double tolerance,
                int most = 30);

/// The fixed point with all points open, whatever the stops. Nothing where 1 is a multiplier of it.
std::optional<Eigen::VectorXd> free_orbit(PeriodicMap& map, double parameter, const MapClock& clock);

/// x with every number that is not 0 one unit in the last place larger.
Eigen::VectorXd one_unit_on(Eigen::VectorXd x);

/// What round-off makes of a period: the distance between the images of x and of a state one unit in the last place
/// away in every number, m.
double round_off_of_map(PeriodicMap& map, const Eigen::VectorXd& x, double parameter, const MapClock& clock);

/// How many units of round-off count as none.
inline constexpr double round_offs = 30;
/// Above it a residual that falls no more is no round-off, m.
inline constexpr double largest_round_off = 1e-9;
/// Above it nothing is an orbit, however badly the map is rounded, and affine steps are not those that are marched, m.
inline constexpr double largest_residual = 1e-8;
/// How many tolerances a residual of steps may stay at where an iteration gains nothing: it is round-off.
inline constexpr double stalled = 100;

}  // namespace ricochet
