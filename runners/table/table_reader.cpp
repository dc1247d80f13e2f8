#include "runners/table/table_reader.hpp"

#include <algorithm>

namespace ricochet {

std::size_t TableReader::column(std::string_view name) const {
  if (const std::size_t place = column_if_any(name); place != absent) return place;
  throw TableError("the table " + table_->name + " has no column " + std::string(name));
}

std::size_t TableReader::column_if_any(std::string_view name) const {
  return find_column(table_->columns, name).value_or(absent);
}

const Cell& TableReader::cell(std::size_t row, std::size_t column) const {
  static const Cell nothing;
  const Row& cells = table_->rows.at(row);
  return column < cells.size() ? cells[column] : nothing;
}

const Table* find_table(const std::vector<Table>& tables, std::string_view name) {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const Table& table) { return table.name == name; });
  return found == tables.end() ? nullptr : &*found;
}

Table* find_table(std::vector<Table>& tables, std::string_view name) {
  return const_cast<Table*>(find_table(std::as_const(tables), name));
}

}  // namespace ricochet
