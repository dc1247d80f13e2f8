#include "runners/table/csv_text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace ricochet {

void append_csv_number(double value, std::string& text) {
  if (!std::isfinite(value)) return;
  std::array<char, 32> digits{};
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

std::string csv_number(double value) {
  std::string text;
  append_csv_number(value, text);
  return text;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

std::string csv_cell(const Cell& cell) {
  return csv_field(cell.text());
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) line += ',';
    line += fields[i];
  }
  return line + '\n';
}

std::vector<std::string> csv_head(const std::vector<Column>& columns) {
  std::vector<std::string> fields;
  for (const Column& column : columns) fields.push_back(csv_field(column.name));
  return fields;
}

std::string table_csv(const Table& table) {
  std::string text = csv_line(csv_head(table.columns));
  std::vector<std::string> fields;
  for (const Row& row : table.rows) {
    fields.clear();
    for (const Cell& cell : row) fields.push_back(csv_cell(cell));
    text += csv_line(fields);
  }
  return text;
}

}  // namespace ricochet
