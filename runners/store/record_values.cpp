#include "runners/store/record_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "runners/study/axis_meaning.hpp"

namespace ricochet {

bool went_wrong(const CaseRecord& record) {
  return record.status == "diverged" || record.status == "failed";
}

std::optional<double> measure(const CaseRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.measures)
    if (key == name) return value;
  return std::nullopt;
}

void put_measure(CaseRecord& record, const std::string& name, double value) {
  if (std::isfinite(value)) record.measures.emplace_back(name, value);
}

Cell axis(const CaseRecord& record, const std::string& column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return cell_of(value);
  return {};
}

Row axes_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  Row row;
  for (const std::string& column : columns) row.push_back(axis(record, column));
  return row;
}

std::string key_of(const Row& row) {
  std::string key;
  for (const Cell& cell : row) key += cell.text() + '\x1f';
  return key;
}

std::vector<Cases> groups_of(const Cases& cases, const std::vector<std::string>& columns) {
  std::vector<Cases> groups;
  std::map<std::string, std::size_t> place;
  for (const CaseRecord* record : cases) {
    const auto [at, fresh] = place.emplace(key_of(axes_of(*record, columns)), groups.size());
    if (fresh) groups.emplace_back();
    groups[at->second].push_back(record);
  }
  return groups;
}

Cases all_cases(const StudyResults& results) {
  Cases all;
  for (const CaseRecord& record : results.cases) all.push_back(&record);
  return all;
}

Cases with_status(const Cases& cases, const std::string& status) {
  Cases found = cases;
  std::erase_if(found, [&](const CaseRecord* record) { return record->status != status; });
  return found;
}

Column axis_column(const StudyResults& results, const std::string& name) {
  const auto known = find_column(results.axes, name);
  return known ? results.axes[*known] : axis_meaning(name, results.study);
}

std::vector<Column> axis_columns(const StudyResults& results, const std::vector<std::string>& names) {
  std::vector<Column> columns;
  for (const std::string& name : names) columns.push_back(axis_column(results, name));
  return columns;
}

Column case_column() {
  return {"case", "", "The case: ten hexadecimal digits that depend on its axes alone, the same in every table."};
}

std::vector<Column> place_columns(const StudyResults& results) {
  return joined({case_column()}, axis_columns(results, results.columns));
}

Row place_of(const StudyResults& results, const CaseRecord& record) {
  return place_of(record, results.columns);
}

Row place_of(const CaseRecord& record, const std::vector<std::string>& columns) {
  Row row = {record.id};
  for (const std::string& column : columns) row.push_back(axis(record, column));
  return row;
}

void add_row(Table& table, Row place, const Row& cells) {
  place.insert(place.end(), cells.begin(), cells.end());
  table.rows.push_back(std::move(place));
}

void append_rows(const StudyResults& results, const CaseRecord& record, const Table& own, Table& into) {
  // Cases of one study may have different columns (as many exponents as each was asked for).
  for (const Column& column : own.columns)
    if (!find_column(into.columns, column.name)) {
      into.columns.push_back(column);
      for (Row& row : into.rows) row.emplace_back();
    }
  std::vector<std::size_t> places;
  for (const Column& column : own.columns) places.push_back(*find_column(into.columns, column.name));
  const Row place = place_of(results, record);
  for (const Row& row : own.rows) {
    Row whole = place;
    whole.resize(into.columns.size());
    for (std::size_t c = 0; c < places.size() && c < row.size(); ++c) whole[places[c]] = row[c];
    into.rows.push_back(std::move(whole));
  }
}

Table table_of_cases(const StudyResults& results, std::string name, std::string text,
                     const std::vector<Column>& columns) {
  std::vector<Column> place = place_columns(results);
  for (const Column& column : columns)
    if (find_column(place, column.name))
      throw std::logic_error("the table " + name + " has a column \"" + column.name +
                             "\", which is what an axis of the study is called");
  return {std::move(name), std::move(text), joined(std::move(place), columns), {}};
}

Table table_of_cases(const StudyResults& results, const Table& own) {
  return table_of_cases(results, own.name, own.text, own.columns);
}

Cell cell_of(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get_ref<const std::string&>();
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_float()) return value.get<double>();
  const bool fits = !value.is_number_unsigned() ||
                    value.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (value.is_number_integer() && fits) return value.get<std::int64_t>();
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

nlohmann::ordered_json json_of(const Cell& cell) {
  return cell.visit([](const auto& content) -> nlohmann::ordered_json {
    if constexpr (std::is_same_v<std::decay_t<decltype(content)>, std::monostate>)
      return nullptr;
    else
      return content;
  });
}

}  // namespace ricochet
