#include "runners/report/derived/shown_tables.hpp"

#include <algorithm>

namespace ricochet::report {

std::vector<Table> shown_tables(const StudyResults& results) {
  const CaseView view(results);
  std::vector<Table> out;
  for (const auto make :
       {energy_changes, order_lines, work_points, stability_cells, stability_limits, stability_disagreements,
        distance_spreads, distance_medians, exponent_methods, basin_counts, basin_failures, effects_said}) {
    Table table = make(view);
    const bool known = std::any_of(results.derived.begin(), results.derived.end(),
                                   [&](const Table& one) { return one.name == table.name; });
    if (!known && !table.rows.empty()) out.push_back(std::move(table));
  }
  return out;
}

}  // namespace ricochet::report
