#pragma once
#include "runners/check/law_bench.hpp"

/// \file
/// What is looked at in a contact law.
namespace ricochet::checking {

// Rigid laws.
Verdict complementarity_holds(const Law& law);

// Compliant laws (law_compliant.cpp).
Verdict force_law_is_one(const Law& law);
Verdict solution_answers_the_force_law(const Law& law);
Verdict stiffness_as_declared(const Law& law);
Verdict slopes_are_derivatives(const Law& law);
Verdict potential_stores_the_force(const Law& law);
Verdict energy_over_a_step(const Law& law);
Verdict dissipation_is_reported(const Law& law);

// Laws that change the problem.
Verdict changed_problem_is_sound(const Law& law);

// All laws.
Verdict solve_allocates_nothing(const Law& law);
Verdict lanes_are_independent(const Law& law);
Verdict untouched_lanes_are_left_alone(const Law& law);
Verdict warm_start_changes_nothing(const Law& law);
Verdict points_have_own_sets(const Law& law);  // law_points.cpp

const std::vector<Check<ContactLaw>>& law_checks();

}  // namespace ricochet::checking
