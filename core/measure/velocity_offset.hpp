#pragma once
#include <ricochet/contract/step_plan.hpp>

namespace ricochet {

/// Where in time a scheme's velocity stands at the end of a step, in steps: 0, or −½ where it is a mean over the step.
/// Found on a unit mass under a unit force, from rest.
double velocity_offset(const StepPlan& plan);

}  // namespace ricochet
