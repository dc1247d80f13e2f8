#pragma once
#include "runners/store/record.hpp"

namespace ricochet {

/// The study of one case alone, of its own kind: its methods and mesh, its step where it has one, every other key as
/// the study has it. Axes of the scene stay lists, of one value: the case keeps its id, and its bits. `minimal_study`
/// makes a trajectory of it instead.
nlohmann::ordered_json single_study(const StudyResults& results, const CaseRecord& record);

}  // namespace ricochet
