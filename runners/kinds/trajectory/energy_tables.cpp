#include "runners/kinds/trajectory/energy_tables.hpp"

#include <algorithm>
#include <cmath>

#include "runners/answers/limits.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

/// A measure over the energy that was brought in; nothing where that is not positive.
std::optional<double> of_brought_in(const CaseRecord& record, const char* name) {
  const auto value = measure(record, name), all = measure(record, "energy_brought_in");
  return value && all && *all > 0 ? std::optional(*value / *all) : std::nullopt;
}

Cases done_cases(const StudyResults& results) {
  return with_status(all_cases(results), Status::done);
}

}  // namespace

double energy_noise(const CaseRecord& record) {
  const double round_off = 0x1p-52 * static_cast<double>(record.steps);
  const auto residual = of_brought_in(record, "balance_residual");
  return residual && std::abs(*residual) <= exact_balance ? std::max(round_off, std::abs(*residual)) : round_off;
}

TableType<EnergyEnd> energy_ends_type() {
  RowType<EnergyEnd> rows;
  rows.of_case(&EnergyEnd::id)
      .add({"energy", "J", "The common mechanical energy at the end."}, &EnergyEnd::energy)
      .add({"ratio", "1", "The same over the energy brought in."}, &EnergyEnd::ratio)
      .add({"change", "1", "Distance of that ratio from 1."}, &EnergyEnd::change)
      .add({"noise_floor", "1",
            "Share of the change that is not told from round-off: 2⁻⁵² times the number of steps. Where the balance is "
            "exact, its residual over the energy brought in, if that is larger."},
           &EnergyEnd::noise_floor)
      .add({"kept", "", "Whether the change is within the noise floor."}, &EnergyEnd::kept)
      .add({"step_gain", "1", "Largest gain of one step over the energy brought in."}, &EnergyEnd::step_gain)
      .add({"gains", "", "Whether that is more than 1e-9 of it."}, &EnergyEnd::gains)
      .add({"lost_at_contact", "1", "What the contact efforts took out, over the energy brought in."},
           &EnergyEnd::lost_at_contact)
      .add({"conservative", "", "Whether nothing but contact changes the energy of the study's finished cases."},
           &EnergyEnd::conservative);
  return {"energy_ends", "One finished case: what its energy ends at, and what is told from round-off.", rows};
}

Table energy_ends_table(const StudyResults& results) {
  const TableType<EnergyEnd> type = energy_ends_type();
  Table table = table_of_cases(results, type.head());
  const bool conservative = answers::keeps_energy(results);
  for (const CaseRecord* record : done_cases(results)) {
    EnergyEnd row;
    row.id = record->id;
    row.energy = measure(*record, "energy_end");
    row.ratio = measure(*record, "energy_left");
    if (!row.energy && !row.ratio) continue;
    row.noise_floor = energy_noise(*record);
    if (row.ratio) {
      row.change = std::abs(*row.ratio - 1);
      row.kept = *row.change <= row.noise_floor;
    }
    row.step_gain = of_brought_in(*record, "largest_step_gain");
    if (row.step_gain) row.gains = *row.step_gain > step_gain_threshold;
    row.lost_at_contact = of_brought_in(*record, "dissipated_at_contact");
    row.conservative = conservative;
    add_row(table, place_of(results, *record), type.rows.row(row));
  }
  return table;
}

Table energy_ledger_table(const StudyResults& results) {
  Table table = table_of_cases(
      results, "energy_ledger",
      "One finished case: where its energy came from and where it went. end = start + loads − damping − stops − scheme "
      "− form + residual.",
      {{"start", "J", "The common energy of the initial state."},
       {"loads", "J",
        "What loads in time and moving supports brought in; steady loads have a potential in the energy."},
       {"damping", "J", "What the viscous forces took."},
       {"stops", "J", "What contact took, less what springs at the stops still hold."},
       {"scheme", "J", "What the scheme itself took in flight: the losses that it declares, else 0."},
       {"form", "J",
        "Change of what the scheme's own energy, whose balance this is, holds beyond the common one; 0 where it "
        "declares none."},
       {"residual", "J",
        "What the balance fails to close by: round-off where the scheme's balance is exact, else losses that it does "
        "not declare."},
       {"end", "J", "The common energy at the end."},
       {"closes", "",
        "exact: the residual is below 1e-8 of the energy brought in; otherwise not exact. Not known: the scheme "
        "declares no work form, so that works and residual are empty."}});
  for (const CaseRecord* record : with_status(all_cases(results), Status::done)) {
    const auto of = [&](const char* name) { return measure(*record, name); };
    const auto start = of("energy_start"), end = of("energy_end");
    if (!start || !end) continue;
    const auto residual = of("balance_residual"), brought_in = of("energy_brought_in");
    if (!residual || !brought_in) {
      add_row(table, place_of(results, *record), {*start, {}, {}, {}, {}, {}, {}, *end, "not known"});
      continue;
    }
    const auto own_start = of("scheme_energy_start"), own_end = of("scheme_energy_end");
    const double stored = of("stored_at_stops").value_or(0), steady = of("work_of_steady_loads").value_or(0);
    const double loads = of("work_of_loads").value_or(0) - steady;
    const double form = own_start && own_end ? (*own_end - *own_start) - (*end - stored - *start) - steady : 0.0;
    add_row(table, place_of(results, *record),
            {*start, loads, of("work_of_damping"), of("dissipated_at_contact"), of("dissipated_by_scheme").value_or(0),
             form, *residual, *end, std::abs(*residual) <= exact_balance * *brought_in ? "exact" : "not exact"});
  }
  return table;
}

}  // namespace ricochet
