#include <cmath>

#include "runners/kinds/trajectory/energy_tables.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {

Table energy_ledger_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "energy_ledger",
      "One finished case: where its energy came from and where it went. end = start + loads − damping − stops − scheme "
      "− "
      "form + residual.",
      {{"start", "J", "The common energy of the initial state."},
       {"loads", "J", "What the load and the moving support brought in."},
       {"damping", "J", "What the viscous forces took."},
       {"stops", "J", "What contact took, less what springs at the stops still hold."},
       {"scheme", "J", "What the scheme itself took in flight: the losses that it declares, else 0."},
       {"form", "J",
        "Change of what the scheme's own energy, whose balance this is, holds beyond the common one; 0 where it "
        "declares "
        "none."},
       {"residual", "J",
        "What the balance fails to close by: round-off where the scheme's balance is exact, else losses that it does "
        "not declare."},
       {"end", "J", "The common energy at the end."},
       {"closes", "",
        "exact: the residual is below 1e-8 of the energy brought in; not exact; not known: the scheme declares no work "
        "form, so that works and residual are empty."}});
  for (const CaseRecord* record : with_status(all_cases(results), "done")) {
    const auto of = [&](const char* name) { return measure(*record, name); };
    const auto start = of("energy_start"), end = of("energy_end");
    if (!start || !end) continue;
    const auto residual = of("balance_residual"), brought_in = of("energy_brought_in");
    if (!residual || !brought_in) {
      add_row(table, place_of(results, *record), {*start, {}, {}, {}, {}, {}, {}, *end, "not known"});
      continue;
    }
    const auto own_start = of("scheme_energy_start"), own_end = of("scheme_energy_end");
    const double stored = of("stored_at_stops").value_or(0);
    const double form = own_start && own_end ? (*own_end - *own_start) - (*end - stored - *start) : 0.0;
    add_row(table, place_of(results, *record),
            {*start, of("work_of_loads"), of("work_of_damping"), of("dissipated_at_contact"),
             of("dissipated_by_scheme").value_or(0), form, *residual, *end,
             std::abs(*residual) <= exact_balance * *brought_in ? "exact" : "not exact"});
  }
  return table;
}

}  // namespace ricochet
