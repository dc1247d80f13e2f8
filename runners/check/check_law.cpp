#include "runners/check/checks.hpp"
#include "runners/check/law_checks.hpp"

namespace ricochet::checking {

const std::vector<Check<ContactLaw>>& law_checks() {
  static const std::vector<Check<ContactLaw>> all = {
      {"manual", [](const Law& law) { return manual_complete(law.entry->manual); }},
      {"complementarity", complementarity_holds},
      {"force law", force_law_is_one},
      {"solution", solution_answers_the_force_law},
      {"constant stiffness", stiffness_as_declared},
      {"slopes", slopes_are_derivatives},
      {"potential", potential_stores_the_force},
      {"energy over a step", energy_over_a_step},
      {"dissipation", dissipation_is_reported},
      {"changed problem", changed_problem_is_sound},
      {"no allocation", solve_allocates_nothing},
      {"lanes independent", lanes_are_independent},
      {"untouched lanes", untouched_lanes_are_left_alone},
      {"warm start", warm_start_changes_nothing},
  };
  return all;
}

std::vector<CheckResult> check_law(const Entry<ContactLaw>& entry, const Isolation& isolation) {
  return run_checks(law_checks(), entry, isolation);
}

}  // namespace ricochet::checking
