#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"

namespace ricochet {

/// What would run for a case of kind `continuation`.
CasePlan plan_continuation(const StudyCase& study_case, const Registry& registry);

/// Solves the orbits of one case and follows their branches. Tables `branches`, `special_points`, `turns`. A case one
/// of whose orbits is not found is failed; the branches of the others are there.
CaseRecord run_continuation(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                            const std::atomic<bool>& stop);

}  // namespace ricochet
