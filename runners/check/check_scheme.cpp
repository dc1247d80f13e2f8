#include "runners/check/checks.hpp"
#include "runners/check/scheme_checks.hpp"

namespace ricochet::checking {

const std::vector<Check<TimeScheme>>& scheme_checks() {
  static const std::vector<Check<TimeScheme>> all = {
      {"manual", [](const Scheme& scheme) { return manual_complete(scheme.entry->manual); }},
      {"well-formed", plan_is_well_formed},
      {"same plan twice", plan_is_the_same_twice},
      {"refusals", refusals_name_cause},
      {"singular mass", singular_mass_as_declared},
      {"march = plan", march_is_the_plan},
      {"march = spectrum", spectrum_is_the_march},
      {"stability limit", stability_as_declared},
      {"order and start", order_as_declared},
      {"velocity", velocity_stands_right},
      {"loads", loads_at_their_times},
      {"moving support", supports_at_their_times},
      {"compliant contact", compliance_is_right},
      {"rigid stops", rigid_stops_hold},
      {"restitution", restitution_as_declared},
      {"start at a stop", start_at_a_stop},
      {"order at contact", contact_order_as_declared},
      {"impulse", impulse_is_momentum},
      {"energy", energy_in_free_flight},
      {"work form", work_form_closes},
      {"energy at contact", contact_gains_as_declared},
  };
  return all;
}

std::vector<CheckResult> check_scheme(const Entry<TimeScheme>& entry, const Isolation& isolation) {
  return run_checks(scheme_checks(), entry, isolation);
}

}  // namespace ricochet::checking
