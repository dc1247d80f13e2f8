#pragma once
#include <map>
#include <string>
#include <vector>

#include "runners/store/record_values.hpp"
#include "runners/table/row_type.hpp"

namespace ricochet {

/// A table of rows that speak of a case each, the one of their `id`: `case`, the axes of the case, then their columns.
/// Throws std::out_of_range where there is no such case.
template <class Record>
Table rows_of_cases(const StudyResults& results, const TableType<Record>& type, const std::vector<Record>& rows) {
  std::map<std::string, const CaseRecord*> by_id;
  for (const CaseRecord& record : results.cases) by_id.emplace(record.id, &record);
  Table table = table_of_cases(results, type.head());
  for (const Record& row : rows) add_row(table, place_of(results, *by_id.at(row.id)), type.rows.row(row));
  return table;
}

}  // namespace ricochet
