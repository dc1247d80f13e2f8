#include "runners/run/derive.hpp"

#include <algorithm>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/comparison/precision_targets.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/kinds/stability/step_limits.hpp"
#include "runners/kinds/sweep/derive_dynamics.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/kinds/trajectory/energy_tables.hpp"
#include "runners/run/effects_table.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

bool compares(const StudyResults& results) {
  return results.kind == "convergence" || results.kind == "work-precision";
}

// What the store does not say: units and meanings of the tables that the cases left.
void describe_cases(StudyResults& results) {
  const SweptColumns swept = swept_columns(results);
  for (CaseRecord& record : results.cases)
    if (has_dynamics(results))
      describe_sweep(record, swept);
    else
      describe_stability(record);
}

// The tables that cases carry, each row behind its case and axes.
void collect(StudyResults& results) {
  for (const CaseRecord& record : results.cases)
    for (const Table& own : record.tables) {
      if (has_dynamics(results) && derived_as_dynamics(own.name)) continue;
      auto found = std::find_if(results.derived.begin(), results.derived.end(),
                                [&](const Table& table) { return table.name == own.name; });
      if (found == results.derived.end())
        found = results.derived.insert(results.derived.end(), table_of_cases(results, own));
      append_rows(results, record, own, *found);
    }
}

}  // namespace

void derive_tables(StudyResults& results) {
  results.derived.clear();
  describe_cases(results);
  if (compares(results)) {
    results.derived.push_back(errors_table(results));
    results.derived.push_back(orders_table(results));
    results.derived.push_back(order_verdicts_table(results.derived.back()));
  }
  if (results.kind == "work-precision") {
    results.derived.push_back(work_precision_table(results));
    results.derived.push_back(precision_targets_table(results));
  }
  collect(results);
  if (results.kind == "stability") {
    results.derived.push_back(step_limits_table(results));
    results.derived.push_back(step_limit_agreement_table(results.derived.back()));
  }
  if (results.kind == "trajectory")
    for (Table table : {energy_ends_table(results), energy_by_mass_table(results), energy_trends_table(results),
                        choice_worth_table(results)})
      if (!table.rows.empty()) results.derived.push_back(std::move(table));
  if (has_dynamics(results)) derive_dynamics(results);
  if (Table effects = effects_table(results); !effects.rows.empty()) results.derived.push_back(std::move(effects));
}

}  // namespace ricochet
