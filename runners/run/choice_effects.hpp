#pragma once
#include <ricochet/measure/statistics/effects.hpp>
#include <string>
#include <vector>

#include "runners/store/record_values.hpp"

/// \file
/// What each choice of a study makes of a measure, against what step and mesh leave open.
namespace ricochet {

/// A difference below this share of its scale is said not to matter.
inline constexpr double answer_threshold = 0.01;

/// Whether a column is refined rather than chosen: the step, the mesh.
bool refines(const std::string& column);

/// The levels of one choice with all other choices the same, each by its finest case.
struct GroupEffect {
  ResolvedEffect found;  ///< in units of the scale
  Cases levels;          ///< the finest finished case of each level
  double step = 0;       ///< the finest step, s; 0 where the cases have none
  double elements = 0;   ///< of the finest mesh; 0 where the cases have none
};

/// One choice and one measure over all groups with two levels or more.
struct ChoiceEffects {
  std::string choice, measure, scale;  ///< scale in words: "of the energy brought in", "of the larger"
  std::vector<GroupEffect> groups;
  std::size_t count(EffectVerdict verdict) const;
};

/// Every choice that varies (a method with its parameters is one) but step and mesh, with every measure given, in
/// that order.
std::vector<ChoiceEffects> choice_effects(const StudyResults& results, const std::vector<std::string>& measures);

}  // namespace ricochet
