#pragma once
#include <string>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// What the step of a case makes of its tables and spectra, a sentence each: a table with many steps between its
/// entries, a spectrum whose highest line has fewer than five steps in its period.
std::vector<std::string> table_notes(const StudyCase& study_case);

/// Tables of a scene whose entries, Δ apart, resolve nothing above 1/2Δ, where the structure has a mode of one of these
/// pulsations (rad/s, in order) above: a sentence each.
std::vector<std::string> coarse_tables(const SceneSpec& scene, const std::vector<double>& pulsations);

}  // namespace ricochet
