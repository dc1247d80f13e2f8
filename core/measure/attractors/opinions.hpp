#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <ricochet/measure/attractors/diagram.hpp>
#include <ricochet/measure/statistics/choices.hpp>
#include <set>
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

// Whether the cases of a diagram agree on the attractors, value by value, and which choice tells them apart.

enum class Robustness {
  robust,     ///< every case that counts shows the same attractors
  depends,    ///< they differ
  undecided,  ///< those that decide agree, others are open
};

/// What the cases say at one value.
struct Opinion {
  int value = 0;
  Robustness verdict = Robustness::undecided;
  DecidingChoice choice = {};                          ///< where they differ
  std::map<std::size_t, std::set<int>> decided = {};   ///< case → attractors
  std::map<std::size_t, const DiagramRun*> open = {};  ///< case → the last of its runs that is not decided
  bool same_classes = true;                            ///< the attractors differ, their classes do not
  /// Whether one choice tells half of the differences or more.
  bool one_choice() const;
};

/// Neighbouring values of one verdict and one choice.
using Stretch = std::vector<Opinion>;

/// The stretches along the parameter: of values that two cases or more speak of, and half of those that any value has
/// (a change that one case refined is no place to compare). A case that decides nothing anywhere says nothing of any
/// value. `axes` hold a level for each case.
std::vector<Stretch> stretches_of(const Diagram& diagram, const std::vector<ChoiceAxis>& axes);

/// The class of each attractor, by its number.
std::map<int, MotionClass> attractor_classes(const Diagram& diagram);

/// Sets of attractors that the given cases show over a stretch, most frequent first.
std::vector<std::set<int>> attractor_sets(const Stretch& stretch, const std::set<std::size_t>& cases);

/// A numerical viscosity counts as small up to this share of the physical one.
inline constexpr double small_viscosity = 0.01;

/// The cases of a stretch whose numerical viscosity is not small against α (a hundredth of it; 1e-12 s, which is what
/// round-off leaves of none, where the structure has none), and which choice they share.
struct ThickCases {
  std::set<std::size_t> told, thick;  ///< cases whose viscosity is known; those where it is not small
  double largest = 0;                 ///< s
  double physical = 0;                ///< α beside the largest, s
  DecidingChoice choice = {};
};
/// `viscosity` is α of a run, s; nothing where the structure has no such number.
ThickCases thick_cases(
    const Diagram& diagram, const Stretch& stretch, const std::vector<ChoiceAxis>& axes,
    const std::function<std::optional<double>(std::size_t case_index, const DiagramRun&)>& viscosity);

}  // namespace ricochet
