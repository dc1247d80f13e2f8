#include "runners/kinds/sweep/derive_dynamics.hpp"

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"
#include "runners/kinds/sweep/sweep_summaries.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

using namespace dynamics;

Table values_table(const Diagram& diagram) {
  const StudyResults& results = *diagram.results;
  Table table = table_of_cases(results, values_head(0, diagram.swept).name, values_head(0, diagram.swept).text, {});
  for (const CaseRuns& owner : diagram.cases) {
    const std::size_t first = table.rows.size();
    append_rows(results, *owner.record, *owner.table, table);
    const auto column = find_column(table.columns, "attractor");
    if (!column) continue;
    for (const Run& run : owner.runs)
      if (run.attractor > 0) table.rows[first + run.row][*column] = run.attractor;
  }
  return table;
}

Table bifurcations_table(const Diagram& diagram) {
  const Table head = bifurcations_head(diagram.swept);
  Table table = table_of_cases(*diagram.results, head.name, head.text, {});
  for (const CaseRuns& owner : diagram.cases)
    if (const Table* own = find_table(owner.record->tables, head.name))
      append_rows(*diagram.results, *owner.record, *own, table);
  return table;
}

}  // namespace

bool has_dynamics(const StudyResults& results) {
  return results.kind == "bifurcation" || results.kind == "basins";
}

bool derived_as_dynamics(const std::string& table) {
  return table == "values" || table == "bifurcations" || table == "cells";
}

void derive_dynamics(StudyResults& results) {
  if (results.kind == "basins") return derive_basins(results);
  Diagram diagram = read_diagram(results);
  if (diagram.cases.empty()) return;
  Table distances = find_attractors(diagram);
  std::vector<Table> tables = {values_table(diagram), bifurcations_table(diagram), attractors_table(diagram),
                               std::move(distances),  verdicts_table(diagram),     agreement_table(diagram),
                               shifts_table(diagram)};
  tables.push_back(verdict_shares_table(*find_table(tables, "verdicts"), diagram.swept));
  for (Table table :
       {class_counts_table(results), grazing_ranges_table(results, diagram.swept), numerical_viscosity_table(results)})
    tables.push_back(std::move(table));
  for (Table& table : tables) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
