#pragma once
#include "runners/check/mass_spaces.hpp"

/// \file
/// What is looked at in a mass strategy (mass_matrix.cpp, mass_structure.cpp).
namespace ricochet::checking {

Verdict some_structure_is_accepted(const Mass& mass);
Verdict matrix_is_symmetric(const Mass& mass);
Verdict matrix_is_semidefinite(const Mass& mass);
Verdict kernel_as_declared(const Mass& mass);
Verdict total_mass_is_right(const Mass& mass);
Verdict ends_are_treated_alike(const Mass& mass);
Verdict frequencies_converge(const Mass& mass);

const std::vector<Check<MassStrategy>>& mass_checks();

}  // namespace ricochet::checking
