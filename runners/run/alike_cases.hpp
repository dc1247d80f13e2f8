#pragma once
#include <string>

#include "runners/study/study.hpp"

namespace ricochet {

/// Cases of the same key cost about the same: the same methods, mesh, steps and settings, in scenes whose numbers
/// differ in size alone. One that is 0 here and not there sets cases apart, as what it feeds is left out.
std::string cost_key(const StudyCase& study_case);

}  // namespace ricochet
