#pragma once
#include <filesystem>
#include <string>

#include "runners/store/store.hpp"
#include "runners/study/study_part.hpp"

/// \file
/// What a run says of its folder, beside progress and answer.
namespace ricochet {

/// What became of results of other versions of the study, and of another arithmetic: lines, or "".
std::string versions_text(const Store& store);

/// Why a folder that holds `held` is not gone on with as `wanted`.
std::string other_part_text(const std::filesystem::path& folder, const std::string& study, const StudyPart& held,
                            const StudyPart& wanted);

/// How much of an interrupted run is kept, and how it goes on.
std::string interrupted_text(const std::filesystem::path& folder, const StudyResults& results);

}  // namespace ricochet
