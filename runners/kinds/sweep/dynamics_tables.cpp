#include "runners/kinds/sweep/dynamics_tables.hpp"

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/sweep_summaries.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

using namespace dynamics;

Table values_table(const StudyDiagram& study) {
  const StudyResults& results = *study.results;
  const Table head = values_head(0, study.swept);
  Table table = table_of_cases(results, head.name, head.text, {});
  for (std::size_t c = 0; c < study.sources.size(); ++c) {
    const DiagramSource& source = study.sources[c];
    const std::size_t first = table.rows.size();
    append_rows(results, *source.record, *source.table, table);
    const auto column = find_column(table.columns, "attractor");
    if (!column) continue;
    const std::vector<DiagramRun>& runs = study.diagram.cases[c].runs;
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (runs[k].attractor > 0) table.rows[first + source.rows[k]][*column] = runs[k].attractor;
  }
  return table;
}

Table bifurcations_table(const StudyDiagram& study) {
  const Table head = bifurcations_head(study.swept);
  Table table = table_of_cases(*study.results, head.name, head.text, {});
  for (const DiagramSource& source : study.sources)
    if (const Table* own = find_table(source.record->tables, head.name))
      append_rows(*study.results, *source.record, *own, table);
  return table;
}

}  // namespace

bool derived_as_dynamics(const std::string& table) {
  return table == "values" || table == "bifurcations" || table == "cells";
}

void derive_dynamics(StudyResults& results) {
  StudyDiagram study = read_diagram(results);
  if (study.sources.empty()) return;
  Table distances = find_attractors(study);
  std::vector<Table> tables = {values_table(study),  bifurcations_table(study), attractors_table(study),
                               std::move(distances), verdicts_table(study),     agreement_table(study),
                               shifts_table(study)};
  tables.push_back(verdict_shares_table(*find_table(tables, "verdicts"), study.swept));
  for (Table table :
       {class_counts_table(results), grazing_ranges_table(results, study.swept), numerical_viscosity_table(results)})
    tables.push_back(std::move(table));
  for (Table& table : tables) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
