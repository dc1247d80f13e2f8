#include "runners/kinds/sweep/derive_dynamics.hpp"

#include "runners/kinds/basins/derive_basins.hpp"
#include "runners/kinds/sweep/derive_dynamics_parts.hpp"

namespace ricochet {
namespace {

using namespace dynamics;

/// The rows of a case's own table behind its id and axes, in the columns of the whole.
void append_rows(const StudyResults& results, const CaseRecord& record, const DerivedTable& own, DerivedTable& table) {
  for (const std::string& column : own.columns)
    if (!column_of(table, column)) {
      table.columns.push_back(column);
      for (Row& row : table.rows) row.emplace_back(nullptr);
    }
  std::vector<std::size_t> places;
  for (const std::string& column : own.columns) places.push_back(*column_of(table, column));
  for (const Row& row : own.rows) {
    Row whole = axes_row(results, record);
    whole.resize(table.columns.size(), nullptr);
    for (std::size_t c = 0; c < places.size() && c < row.size(); ++c) whole[places[c]] = row[c];
    table.rows.push_back(std::move(whole));
  }
}

DerivedTable values_table(const StudyDiagram& study) {
  const StudyResults& results = *study.results;
  DerivedTable table = table_with_axes(results, "values", {});
  for (std::size_t c = 0; c < study.sources.size(); ++c) {
    const DiagramSource& source = study.sources[c];
    const std::size_t first = table.rows.size();
    append_rows(results, *source.record, *source.table, table);
    const auto column = column_of(table, "attractor");
    if (!column) continue;
    const std::vector<DiagramRun>& runs = study.diagram.cases[c].runs;
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (runs[k].attractor > 0) table.rows[first + source.rows[k]][*column] = runs[k].attractor;
  }
  return table;
}

DerivedTable bifurcations_table(const StudyDiagram& study) {
  DerivedTable table = table_with_axes(*study.results, "bifurcations", {});
  for (const DiagramSource& source : study.sources)
    if (const DerivedTable* own = table_of(*source.record, "bifurcations"))
      append_rows(*study.results, *source.record, *own, table);
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
  StudyDiagram study = read_diagram(results);
  if (study.sources.empty()) return;
  DerivedTable distances = find_attractors(study);
  std::vector<DerivedTable> tables = {values_table(study),  bifurcations_table(study), attractors_table(study),
                                      std::move(distances), verdicts_table(study),     agreement_table(study),
                                      shifts_table(study)};
  for (DerivedTable& table : tables) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
