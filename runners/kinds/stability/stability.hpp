#pragma once
#include <atomic>
#include <ricochet/contract/registry.hpp>
#include <string>
#include <vector>

#include "runners/asks/evidence.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

/// \file
/// Cases of kind `stability`, what they answer, and what a report shows of them.
namespace ricochet {

/// Scenes march this many steps at most, whatever their duration, and free structures always 3000.
constexpr long long most_scene_steps = 200000, least_scene_steps = 200, free_steps = 3000;

/// The steps of a case of kind `stability`, s: evenly spaced on a logarithmic scale. Throws InputError for a range that
/// numbers cannot hold.
std::vector<double> steps_of(const StudyCase& study_case);

/// What would run for a case of kind `stability`: the steps that observation marches at most, bisection not counted.
CasePlan plan_stability(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `stability`: settings {"steps": {"from", "to", "count"}, "observe", "budget"}. Steps are
/// evenly spaced on a logarithmic scale.
/// study_case.duration is the simulated time of observed scenes (0: three periods of the first mode).
///
/// Table `stability`, one row per step and contact state (open, and closed where there are stops). Its columns are
/// step, closed, radius, marginal, limit_predicted, limit_observed, status (stable, marginal, unstable, failed,
/// refused), reason. The closed prediction is the worst of several sets of points held on both sides. What is observed
/// beside it is the scene itself, whose contacts open and close. It is expected to be unstable where either spectrum
/// is, may disagree, and the reason says so. Radii and limits are null where there is none (no limit: every step of the
/// range is stable, or none is).
///
/// Table `stability_observed` where cells were marched: step, closed, behaviour, growth, gain, impacts,
/// changes_per_impact, fast_share, chatter, first_bad_step, steps, cause (see ObservedCell).
///
/// Table `restitution` for a rigid law at a stop, one row: step, least, mean, most (see
/// restitution_range()), rho_inf (see root_at_infinity()).
///
/// Measures: limit_predicted and limit_observed (s, the smaller of open and closed), largest_radius, agreement. The
/// last is observed over expected limit, of the open structure where both have one, else of the scene.
CaseRecord run_stability(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

struct LimitRow;

/// Which step each scheme is allowed on each mesh and with each law, and whether the mesh or the closed stop bounds it.
asks::Answered steps_ask(const asks::Ask& ask, const asks::Evidence& evidence, const std::vector<LimitRow>& limits);

}  // namespace ricochet

// What a report shows: spectral radii, and where steps are stable.
namespace ricochet::report {

struct KindPage;

KindPage stability_page();

/// One row per method and contact state: predicted and observed step limit, how they agree, marginal roots, and what
/// grows first. Empty without the table `step_limits`.
std::string stability_html(const Choices& choices);

/// One row per time scheme: what a free mass keeps of its speed at a rigid stop, and ρ∞. Empty without the table
/// `restitution`.
std::string restitution_html(const Choices& choices);

}  // namespace ricochet::report
