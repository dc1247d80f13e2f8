#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/answers/answer.hpp"
#include "runners/asks/evidence.hpp"
#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"

/// \file
/// Cases of kind `bifurcation`, and what they answer.
namespace ricochet {

/// What would run for a case of kind `bifurcation`.
CasePlan plan_bifurcation(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `bifurcation`: every value of the parameter from every start, as lanes where they share a
/// factorisation. Tables `values`, `bifurcations`; numbers `points`, `impacts`, `portraits` (see the README's table of
/// files) and, not exported, `contact_law`: compliance (m/N; 0: rigid, absent: not known). A value that cannot be
/// marched, diverges or fails is a row with its reason; the case is done when any value is.
CaseRecord run_bifurcation(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                           const std::atomic<bool>& stop);

struct SweptMotions;

/// Which motions there are along the parameter, where they change, and how much of the range is undecided.
asks::Answered motions_of_sweep(const asks::Ask& ask, const asks::Evidence& evidence, const SweptMotions& swept);
/// At how many values a choice changes the motion.
asks::Answered effect_on_sweep(const asks::Ask& ask, const asks::Evidence& evidence, const SweptMotions& swept);
/// What a study that asks nothing is asked: its motions, and what choices change of them.
Json default_sweep_asks(const Json& resolved);
void check_sweep_ask(const Study& study, const Json& ask, const std::string& pointer);

}  // namespace ricochet
