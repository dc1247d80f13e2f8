#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// The smallest study that shows what happened to one case: kind `trajectory`, its scene and methods alone, every list
/// replaced by the case's value, without excludes. Runs as it stands.
nlohmann::ordered_json minimal_study(const StudyResults& results, const CaseRecord& record);

}  // namespace ricochet
