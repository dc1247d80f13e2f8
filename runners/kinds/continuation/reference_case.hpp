#pragma once
#include <atomic>
#include <ricochet/contract/registry.hpp>
#include <vector>

#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

/// \file
/// Cases that a reference solves: orbits of the scene itself, without a mesh and steps of time.
namespace ricochet {

/// Appends a case for each reference and each scene of the study: "reference", "reference-2", … Their axes are those of
/// the scene. Throws InputError for what has no orbits of its own.
void add_reference_cases(const std::vector<MethodChoice>& references, Study& study);

CasePlan plan_reference(const StudyCase& study_case, const Registry& registry);
/// Follows its orbits by steps of arclength. Throws Interrupted where `stop` became true.
CaseRecord run_reference(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet
