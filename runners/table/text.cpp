#include "runners/table/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/nil_generator.hpp>
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

std::size_t shown_width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string TextTable::text(std::size_t indent) const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns, 0), shown;
  for (std::size_t column = 0; column < columns; ++column) {
    bool empty = true;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      widths[column] = std::max(widths[column], shown_width(rows_[row][column]));
      empty = empty && (row == 0 || rows_[row][column].empty());
    }
    if (!empty) shown.push_back(column);
  }
  std::string result;
  for (const auto& row : rows_) {
    std::string line(indent, ' ');
    for (const std::size_t column : shown)
      line += row[column] + std::string(widths[column] - shown_width(row[column]) + 2, ' ');
    while (!line.empty() && line.back() == ' ') line.pop_back();
    result += line + "\n";
  }
  return result;
}

std::string duration_text(double seconds) {
  constexpr long long minute = 60, hour = 3600;
  const auto two = [](double value) {
    return value < 9.95 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
  };
  if (seconds < 1e-3) return two(seconds * 1e6) + " µs";
  if (seconds < 1) return two(seconds * 1e3) + " ms";
  if (seconds < 9.95) return two(seconds) + " s";
  const long long whole = std::llround(seconds);
  if (whole < minute) return fmt::format("{} s", whole);
  if (whole < hour) return fmt::format("{} min {:02} s", whole / minute, whole % minute);
  return fmt::format("{} h {:02} min", whole / hour, whole % hour / minute);
}

std::string size_text(double bytes) {
  constexpr const char* units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  constexpr double thousand = 1000, two_digits = 9.95;
  std::size_t unit = 0;
  while (bytes >= thousand - 0.5 && unit + 1 < std::size(units)) {
    bytes /= thousand;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", bytes, unit > 0 && bytes < two_digits ? 1 : 0, units[unit]);
}

std::string content_hash(std::string_view content) {
  const boost::uuids::name_generator_sha1 generator(boost::uuids::nil_uuid());
  std::string text;
  for (const auto byte : generator(content.data(), content.size())) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace ricochet
