#pragma once
#include <algorithm>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/step_observer.hpp>

namespace ricochet {

/// Steps of one lane of which only sums are told. Either they were marched and no stop was looked at, or a flight left
/// them out and contact stayed what it was. In the step after a flight it is the same too, unless
/// Flight::tells_slots().
struct StepInterval {
  long long steps = 0;
  double from = 0;                      ///< when the first begins, s
  std::span<const FreeStep> marched;    ///< each of them; none: they were left out
  Flight* flight = nullptr;             ///< what left them out; null: they were marched
  FlightSums works;                     ///< of steps left out, where the plan has work forms
  std::span<const ClosedPoint> closed;  ///< points that stayed closed; none: nothing was touched
  int instants = 0;                     ///< instants of contact in a step where some did
  double penetration = 0;               ///< largest after any of these steps, m

  /// `see`(displacement) for the absolute displacement of the tip after each step, in turn, m. Of marched steps an
  /// observer asks for it.
  template <class See>
  void each_tip(See&& see) const {
    if (flight) return flight->each_tip(see);
    for (const FreeStep& step : marched) see(step.tip);
  }
  /// Widens [low, high] by these displacements.
  void tip_extremes(double& low, double& high) const {
    if (flight) return flight->tip_extremes(low, high);
    for (const FreeStep& step : marched) {
      low = std::min(low, step.tip);
      high = std::max(high, step.tip);
    }
  }
  /// Of steps left out, each stage in turn: see Flight::each_stage.
  template <class See>
  void each_stage(See&& see) const {
    flight->each_stage(see);
  }
};

}  // namespace ricochet
