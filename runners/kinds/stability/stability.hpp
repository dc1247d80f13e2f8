#pragma once
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// Scenes march this many steps at most, whatever their duration, and free structures always 3000.
constexpr long long most_scene_steps = 200000, least_scene_steps = 200, free_steps = 3000;

/// The steps of a case of kind `stability`, s: evenly spaced on a logarithmic scale. Throws InputError for a range that
/// numbers cannot hold.
std::vector<double> steps_of(const StudyCase& study_case);

}  // namespace ricochet
