#include "runners/run/derive.hpp"

#include <algorithm>

#include "runners/kinds/comparison/comparison_tables.hpp"
#include "runners/kinds/sweep/derive_dynamics.hpp"
#include "runners/run/effects_table.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

using Row = std::vector<nlohmann::ordered_json>;

bool compares(const StudyResults& results) {
  return results.kind == "convergence" || results.kind == "work-precision";
}

// The tables that cases carry, each row behind its case's axes.
void collect(StudyResults& results) {
  for (const CaseRecord& record : results.cases)
    for (const DerivedTable& own : record.tables) {
      if (has_dynamics(results) && derived_as_dynamics(own.name)) continue;
      auto found = std::find_if(results.derived.begin(), results.derived.end(),
                                [&](const DerivedTable& table) { return table.name == own.name; });
      if (found == results.derived.end()) {
        DerivedTable table{own.name, results.columns, {}};
        table.columns.insert(table.columns.end(), own.columns.begin(), own.columns.end());
        found = results.derived.insert(results.derived.end(), std::move(table));
      }
      for (const Row& row : own.rows) {
        Row whole = axes_of(record, results.columns);
        whole.insert(whole.end(), row.begin(), row.end());
        found->rows.push_back(std::move(whole));
      }
    }
}

}  // namespace

void derive_tables(StudyResults& results) {
  results.derived.clear();
  if (compares(results)) {
    results.derived.push_back(errors_table(results));
    results.derived.push_back(orders_table(results));
  }
  if (results.kind == "work-precision") results.derived.push_back(work_precision_table(results));
  collect(results);
  if (has_dynamics(results)) derive_dynamics(results);
  if (DerivedTable effects = effects_table(results); !effects.rows.empty())
    results.derived.push_back(std::move(effects));
}

}  // namespace ricochet
