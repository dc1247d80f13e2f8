#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// "energy 3.61 J → 3.02 J (−16.4 %), 12 impacts, 0.8 µs/step": what a marched case has of these.
std::string energies_text(const CaseRecord& record);

/// The smallest study that shows what happened to one case: kind `trajectory`, its scene and methods alone, every list
/// replaced by the case's value, without excludes. Runs as it stands.
nlohmann::ordered_json minimal_study(const StudyResults& results, const CaseRecord& record);

}  // namespace ricochet
