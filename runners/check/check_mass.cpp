#include "runners/check/checks.hpp"
#include "runners/check/mass_checks.hpp"

namespace ricochet::checking {

const std::vector<Check<MassStrategy>>& mass_checks() {
  static const std::vector<Check<MassStrategy>> all = {
      {"manual", [](const Mass& mass) { return manual_complete(mass.entry->manual); }},
      {"refusals", some_structure_is_accepted},
      {"symmetric", matrix_is_symmetric},
      {"semidefinite", matrix_is_semidefinite},
      {"kernel", kernel_as_declared},
      {"total mass", total_mass_is_right},
      {"both ends alike", ends_are_treated_alike},
      {"frequencies", frequencies_converge},
  };
  return all;
}

std::vector<CheckResult> check_mass(const Entry<MassStrategy>& entry, const Isolation& isolation) {
  return run_checks(mass_checks(), entry, isolation);
}

}  // namespace ricochet::checking
