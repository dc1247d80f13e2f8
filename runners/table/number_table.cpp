#include "runners/table/number_table.hpp"

#include <algorithm>

namespace ricochet {

void NumberTable::add(std::initializer_list<double> row) {
  std::size_t column = 0;
  for (const double value : row) values.at(column++).push_back(value);
}

const Series* NumberTable::series(std::string_view column) const {
  const auto place = find_column(columns, column);
  return place && *place < values.size() ? &values[*place] : nullptr;
}

const std::vector<double>* NumberTable::numbers(std::string_view column) const {
  const Series* found = series(column);
  return found ? &found->get() : nullptr;
}

const std::vector<std::string>* NumberTable::words_of(std::string_view column) const {
  const auto found = std::find_if(words.begin(), words.end(), [&](const auto& one) { return one.first == column; });
  return found == words.end() ? nullptr : &found->second;
}

NumberTable number_table(std::string name, std::vector<Column> columns) {
  NumberTable table;
  table.name = std::move(name);
  table.values.resize(columns.size());
  table.columns = std::move(columns);
  return table;
}

const NumberTable* find_table(const std::vector<NumberTable>& tables, std::string_view name) {
  const auto found =
      std::find_if(tables.begin(), tables.end(), [&](const NumberTable& table) { return table.name == name; });
  return found == tables.end() ? nullptr : &*found;
}

}  // namespace ricochet
