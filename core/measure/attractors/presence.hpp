#pragma once
#include <cstddef>
#include <ricochet/measure/statistics/choices.hpp>
#include <vector>

namespace ricochet {

/// One attractor over the cases that could tell.
struct Presence {
  std::vector<std::size_t> cases;  ///< indices of the cases that decided something where it exists
  std::vector<int> present;        ///< of each, 1 or 0: whether it shows there half as often as in any case, or more
};

/// Share of the differences from which a choice is named.
constexpr double kNamedShare = 0.5;

/// What an attractor hangs on.
enum class PresenceKind {
  not_compared,     ///< fewer than two cases could tell
  common,           ///< every case shows it
  vanishes,         ///< none of the finest cases does, other choices being equal, and a coarser one does
  one_choice,       ///< a choice tells half of its presence or more
  several_choices,  ///< none does
};
struct PresenceVerdict {
  PresenceKind kind = PresenceKind::not_compared;
  std::size_t shown = 0;       ///< cases that show it
  DecidingChoice choice = {};  ///< the best, unless all agree
};

/// `axes` hold a level for each case of the study. Refinement is what the axes `steps_per_period` and `elements` say.
PresenceVerdict judge_presence(const Presence& presence, const std::vector<ChoiceAxis>& axes);

}  // namespace ricochet
