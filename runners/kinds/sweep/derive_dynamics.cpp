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

DerivedTable values_table(const Diagram& diagram) {
  const StudyResults& results = *diagram.results;
  DerivedTable table = table_with_axes(results, "values", {});
  for (const CaseRuns& owner : diagram.cases) {
    const std::size_t first = table.rows.size();
    append_rows(results, *owner.record, *owner.table, table);
    const auto column = column_of(table, "attractor");
    if (!column) continue;
    for (const Run& run : owner.runs)
      if (run.attractor > 0) table.rows[first + run.row][*column] = run.attractor;
  }
  return table;
}

DerivedTable bifurcations_table(const Diagram& diagram) {
  DerivedTable table = table_with_axes(*diagram.results, "bifurcations", {});
  for (const CaseRuns& owner : diagram.cases)
    if (const DerivedTable* own = table_of(*owner.record, "bifurcations"))
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
  DerivedTable distances = find_attractors(diagram);
  std::vector<DerivedTable> tables = {values_table(diagram), bifurcations_table(diagram), attractors_table(diagram),
                                      std::move(distances),  verdicts_table(diagram),     agreement_table(diagram),
                                      shifts_table(diagram)};
  for (DerivedTable& table : tables) results.derived.push_back(std::move(table));
}

}  // namespace ricochet
