#pragma once
#include <functional>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <string>

namespace ricochet {

/// The sentence with which the step h (s) of an explicit scheme is refused where the free structure grows in it: no
/// stage of `plan` solves with K, and the spectral radius of the step, contact open, is beyond 1. It names the
/// largest stable step, found by bisection of the spectrum over plans that `plan_at` makes. "" where the step is
/// stable, the scheme is implicit, or the structure has more dofs than modes are found of.
std::string beyond_explicit_limit(const std::shared_ptr<const SemiDiscrete>& problem, const StepPlan& plan, double h,
                                  const std::function<PlanOrRefusal(double)>& plan_at);

}  // namespace ricochet
