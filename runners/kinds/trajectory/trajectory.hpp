#pragma once
#include <atomic>
#include <memory>
#include <ricochet/contract/registry.hpp>
#include <ricochet/engine/marcher.hpp>

#include "runners/march/prepare_case.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// "energy 3.61 J → 3.02 J (−16.4 %), 12 impacts, 0.8 µs/step": what a marched case has of these.
std::string energies_text(const CaseRecord& record);

/// The smallest study that shows what happened to one case: kind `trajectory`, its scene and methods alone. The case's
/// value replaces every list, and there are no excludes. Runs as it stands.
nlohmann::ordered_json minimal_study(const StudyResults& results, const CaseRecord& record);

/// What would run for a case that integrates its scene once.
CasePlan plan_case(const StudyCase& study_case, const Registry& registry);

/// Runs one case of kind `trajectory` to its end. Whatever goes wrong in it is the record's status and reason; input
/// errors that only show on this case's mesh are InputError.
CaseRecord run_case(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop);

}  // namespace ricochet
