#pragma once
#include <atomic>
#include <memory>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>

#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What would run for a case that integrates its scene once.
CasePlan plan_case(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `trajectory` to its end. Whatever goes wrong in it is the record's status and reason; input
/// errors that only show on this case's mesh are InputError.
CaseRecord run_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet
