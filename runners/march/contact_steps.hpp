#pragma once
#include <optional>
#include <ricochet/measure/contact/impact_recorder.hpp>

#include "runners/march/prepare_case.hpp"

namespace ricochet {

/// How finely a step resolves what a compliant law turns back.
struct ContactSteps {
  double stiffness = 0;  ///< κ, N/m, of the law at the point that is hit hardest; secant of its energy at `depth`
  double half = 0;       ///< s: half a period of the mode that has most of its energy in κ, see contact_spring()
  double steps = 0;      ///< of the march in that time
};

/// Of a march that is over, `depth` (m) the deepest that a point came. Nothing where no stop was hit, for rigid
/// laws and those without an energy, and where contact_spring() knows no such mode.
std::optional<ContactSteps> contact_steps(const StudyCase& study_case, const Marcher& marcher,
                                          const ImpactRecorder& recorder, double depth, const Registry& registry);

/// The sentence on steps fewer than `fewest_contact_steps`; "" where there are more.
Said unresolved(const std::optional<ContactSteps>& found);

}  // namespace ricochet
