#pragma once
#include <ricochet/engine/marcher.hpp>

#include "runners/kinds/continuation/continuation_study.hpp"

namespace ricochet {

/// The state at t = 0 of the forcing of an orbit that a bifurcation study keeps, marched on from where its kept periods
/// began. `program` has one lane, at that value. Throws PointRefused where the study keeps no such orbit, or one of
/// another mesh, step or operator.
LaneState stored_orbit(const WantedOrbit& orbit, Program program, int steps_per_period);

}  // namespace ricochet
