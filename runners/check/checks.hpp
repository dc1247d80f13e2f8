#pragma once
#include <ricochet/contract/registry.hpp>
#include <vector>

#include "runners/check/verdict.hpp"

namespace ricochet::checking {

/// Measures what a method declares, over its parameter values; one result per check.
std::vector<CheckResult> check_scheme(const Entry<TimeScheme>& entry, const Isolation& isolation);
std::vector<CheckResult> check_law(const Entry<ContactLaw>& entry, const Isolation& isolation);
std::vector<CheckResult> check_mass(const Entry<MassStrategy>& entry, const Isolation& isolation);
std::vector<CheckResult> check_reference(const Entry<ReferenceSolver>& entry, const Isolation& isolation);

}  // namespace ricochet::checking
