#pragma once
#include <optional>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"

namespace ricochet::answers {

/// All choices ranked by what they move, the one asked for first.
std::vector<Sentence> say_choices(const Compared& study, const MeasureLimits& limits,
                                  std::vector<ChoiceEffect> effects);

/// What each level of a choice gives, where these values are farther apart than all other choices move any of them:
/// "1.2 to 1.3 N with penalty, 1.5 N with rigid stops". Nothing otherwise, and of more than six levels.
std::optional<Sentence> apart_levels(const Compared& study, const MeasureLimits& limits, const std::string& choice);

/// Of a compared choice with five levels or more: which agree with its first level, the reference, and how far the
/// others are; where none agrees, the levels in tiers of their values. Empty of fewer levels.
std::vector<Sentence> say_levels(const Compared& study, const MeasureLimits& limits);

/// What each level of the compared choice gives, the best first, where the first and the last are apart whatever else
/// is chosen; of at most eight levels.
std::optional<Sentence> say_level_values(const Compared& study, const MeasureLimits& limits);

/// Of a compared number with four values or more that matters: the end of its range in which it moves the measure by a
/// tenth of what matters at most, "from stiffness 1e6 N/m on". Nothing where no two values at an end are so near.
std::optional<Sentence> say_steady_end(const Compared& study, const MeasureLimits& limits);

}  // namespace ricochet::answers
