#pragma once
#include <atomic>
#include <ricochet/contract/registry.hpp>

#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What would run for a case of kind `stability`: the steps that observation marches at most, bisection not counted.
CasePlan plan_stability(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `stability`: settings {"steps": {"from", "to", "count"}, "observe", "budget"}, steps evenly
/// spaced on a logarithmic scale, study_case.duration the simulated time of observed scenes (0: three periods of the
/// first mode).
///
/// Table `stability`, one row per step and contact state (open, and closed where there are stops): step, closed,
/// radius, marginal, limit_predicted, limit_observed, status (stable, marginal, unstable, failed, refused), reason. The
/// closed prediction is the worst of several sets of points held on both sides; what is observed beside it is the scene
/// itself, whose contacts open and close: it is expected to be unstable where either spectrum is, may disagree, and the
/// reason says so. Radii and limits are null where there is none (no limit: every step of the range is stable, or none
/// is).
///
/// Table `stability_observed` where cells were marched: step, closed, behaviour, growth, gain, impacts,
/// changes_per_impact, fast_share, chatter, first_bad_step, steps, cause (see ObservedCell).
///
/// Table `restitution` for a rigid law at a stop, one row: step, least, mean, most (see
/// restitution_range()), rho_inf (see root_at_infinity()).
///
/// Measures: limit_predicted and limit_observed (s, the smaller of open and closed), largest_radius, agreement
/// (observed over expected limit, of the open structure where both have one, else of the scene).
CaseRecord run_stability(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet
