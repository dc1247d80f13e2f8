#pragma once
#include <string>
#include <vector>

#include "runners/run/plan_cases.hpp"

namespace ricochet {

/// What a step makes of the contacts of compliant laws, a line for each law, scheme and step among these cases: how
/// long a contact lasts, half a period π√(m/κ) of the law's spring κ on the mass m that moves in it, how many steps
/// that is, and what part of its energy one bounce of that mass loses at that step, marched over the instants at which
/// it may begin within one. m is κ/ω² of the mode of the structure on that spring at its last contact point that has
/// most of its energy there; of an oscillator it is its mass, on k + κ. Of laws without a constant stiffness nothing is
/// told. "" where there is none.
std::string contacts_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry);

}  // namespace ricochet
