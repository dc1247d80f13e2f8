#pragma once
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"

namespace ricochet::answers {

/// All choices ranked by what they move, the one asked for first.
std::vector<Sentence> say_choices(const Compared& study, const MeasureWords& words, std::vector<ChoiceEffect> effects);

/// Of a compared choice with many levels: which agree with its first level, the reference, and how far the others are.
/// Empty where it has fewer than five levels, or where none agrees.
std::vector<Sentence> say_levels(const Compared& study, const MeasureLimits& limits);

}  // namespace ricochet::answers
