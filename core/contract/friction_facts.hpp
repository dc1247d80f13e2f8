#pragma once
#include <optional>
#include <ricochet/contract/stage_facts.hpp>
#include <string>

namespace ricochet {

/// What a plan makes of friction, found by marching a unit mass.
struct FrictionFacts {
  /// r of a point that friction holds under a constant force: from step to step its effort is off by r times what it
  /// was off before. 0: at once right; −1: it alternates for ever.
  double held_root = 0;
  std::string rings;  ///< why efforts of a held point never settle, "it …"; "" where they do
  /// Why no friction runs under the plan: "it …"; "" where it does, or rings alone.
  std::string why_none;
};

/// Efforts p of friction act on the mass as Σ_k π_k p would, π the weights of the stage's normal effort. Held: p is
/// such that the rate at the end of each stage (StageFacts::end_rate) is 0 under the force 1, and must tend to −1.
/// Sliding: under p = −1 everywhere the mass must lose 1 m/s in 1 s. Each stage whose normal effort gives momentum must
/// have such a rate. None runs where a stage gives the work of contact back.
FrictionFacts friction_facts(const DerivedPlan& derived, const std::optional<Evaluation>& evaluation);

/// Σ_k π_k, or 1 where w brings the effort: what an effort of friction weighs in the equation of its stage.
double friction_weight(const StageEffort& normal);

}  // namespace ricochet
