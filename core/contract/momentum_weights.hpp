#pragma once
#include <optional>
#include <ricochet/contract/stage_facts.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// The momentum (N s per N, hence seconds) that one effort of 1 N finally gives to a free mass, for each stage that may
/// find it. It is the mass times the speed at which the mass goes on once it has settled. With x ← A x a step of a free
/// unit mass without effort, and ℓ A = ℓ,
///
///     ω_k = Σ_j π_j ℓ A_s…A_{k+j+1} g_{k+j}      (and what ι p gives through w)
///
/// where A_i are the maps of s stages and g is what 1 N in the equation of a stage changes the slots by. ℓ gives 1 on a
/// mass at 1 m/s and 0 on all that stays where it is. So ω does not depend on what the unknown z is. A plan of one
/// stage has h, Bathe's two have (h/3, 2h/3), a stage that only projects has 0.
struct EffortMomenta {
  std::vector<double> start, stages;  ///< by stage, s; no numbers where there are none
  std::string why_none;               ///< why an effort gives no definite momentum; "" where each does
};
/// `start`, `efforts`: the weights of the stages of the start rule, and of a step.
EffortMomenta effort_momenta(const StepPlan& plan, const StageEfforts& start, const StageEfforts& efforts);
/// The same of all that reads this evaluation (none: a rigid law).
EffortMomenta effort_momenta(const StepPlan& plan, const std::optional<Evaluation>& evaluation);

}  // namespace ricochet
