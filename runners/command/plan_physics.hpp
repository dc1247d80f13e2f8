#pragma once
#include <string>
#include <vector>

#include "runners/run/plan_cases.hpp"

namespace ricochet {

/// What the structures of these cases are, for a person to see a slip of units at a glance: their numbers, first
/// frequencies, damping ratios, how many steps the study makes of a period, and which modes its steps resolve. On the
/// finest mesh with the first mass matrix; at most a few structures; then their contacts (plan_contacts.cpp). "" where
/// nothing would run.
std::string physics_text(const std::vector<PlannedCase>& cases, const CasePlanner& planner, const Registry& registry);

}  // namespace ricochet
