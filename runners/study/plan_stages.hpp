#pragma once
#include "runners/study/plan_values.hpp"

namespace ricochet {

/// The first refusal of a plan whose condition holds, or nothing. All of them are read.
std::optional<Refusal> plan_refusal(const JsonPlace& plan, PlanValues& values);

/// The slots, stages, energy, velocity and facts of a plan, as numbers. Throws InputError for whatever is no plan; that
/// the plan is well-formed is left to check_plan().
StepPlan read_step_plan(const JsonPlace& plan, PlanValues& values);

}  // namespace ricochet
