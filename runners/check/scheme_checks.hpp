#pragma once
#include "runners/check/bench.hpp"
#include "runners/check/reference_scenes.hpp"

/// \file
/// What is looked at in a time scheme. Each declared fact has a check that measures it, apart from the others.
namespace ricochet::checking {

// Form and answers (scheme_form.cpp).
Verdict plan_is_well_formed(const Scheme& scheme);
Verdict plan_is_the_same_twice(const Scheme& scheme);
Verdict refusals_name_cause(const Scheme& scheme);
Verdict singular_mass_as_declared(const Scheme& scheme);

// Marching against the plan itself (scheme_form.cpp, scheme_orders.cpp).
Verdict march_is_the_plan(const Scheme& scheme);
Verdict spectrum_is_the_march(const Scheme& scheme);
Verdict stability_as_declared(const Scheme& scheme);

// Against closed forms (scheme_orders.cpp).
Verdict order_as_declared(const Scheme& scheme);
Verdict velocity_stands_right(const Scheme& scheme);
Verdict loads_at_their_times(const Scheme& scheme);
Verdict supports_at_their_times(const Scheme& scheme);
Verdict compliance_is_right(const Scheme& scheme);

// Contact and energies (scheme_contact.cpp, scheme_checks.cpp).
Verdict rigid_stops_hold(const Scheme& scheme);
Verdict restitution_as_declared(const Scheme& scheme);
Verdict start_at_a_stop(const Scheme& scheme);
Verdict contact_order_as_declared(const Scheme& scheme);
Verdict impulse_is_momentum(const Scheme& scheme);
Verdict energy_in_free_flight(const Scheme& scheme);
Verdict work_form_closes(const Scheme& scheme);
Verdict contact_gains_as_declared(const Scheme& scheme);

/// The same, in the order of the report.
const std::vector<Check<TimeScheme>>& scheme_checks();

}  // namespace ricochet::checking
