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

namespace {

std::vector<std::string> cells_of(std::string_view line, const TextLines& lines) {
  if (line.find('"') != std::string_view::npos) lines.fail("a quote; expected cells without quotes");
  std::vector<std::string> cells;
  while (true) {
    const std::size_t end = std::min(line.find(','), line.size());
    cells.emplace_back(trimmed(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

std::size_t CsvFile::column(const std::string& key) const {
  const auto found = std::find(columns.begin(), columns.end(), key);
  if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
  std::string nearest = nearest_name(key, columns);
  constexpr std::size_t shortest = 3;
  for (const std::string& one : columns)  // an abbreviation is nearer than any other word
    if (one.size() >= shortest && key.starts_with(one)) nearest = one;
  throw FileError(fmt::format("{} has no column \"{}\"; there are {}{}", name, key, fmt::join(columns, ","),
                              nearest.empty() ? "" : fmt::format(": did you mean {}?", nearest)));
}

void CsvFile::fail(const Row& row, const std::string& what) const {
  throw FileError(fmt::format("{}, line {}: {}", name, row.line, what));
}

double CsvFile::number(const Row& row, std::size_t column) const {
  if (const auto value = finite_number(row.cells[column])) return *value;
  fail(row, fmt::format("\"{}\" for {}; expected a finite number", shortened(row.cells[column]), columns[column]));
}

CsvFile read_csv(std::string_view content, const std::string& name) {
  TextLines lines(content, name);
  CsvFile table;
  table.name = name;
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    std::vector<std::string> cells = cells_of(*line, lines);
    if (table.columns.empty()) {
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (std::find(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(i), cells[i]) !=
            cells.begin() + static_cast<std::ptrdiff_t>(i))
          lines.fail(fmt::format("column \"{}\" stands a second time", shortened(cells[i])));
      table.columns = std::move(cells);
      continue;
    }
    if (cells.size() != table.columns.size())
      lines.fail(fmt::format("{} cells; expected {}, as in the header", cells.size(), table.columns.size()));
    table.rows.push_back({lines.line(), std::move(cells)});
  }
  if (table.columns.empty()) throw FileError(name + " is empty; expected a header of columns");
  return table;
}

namespace {

/// Names are words of a study and of tables.
bool is_name(std::string_view text) {
  constexpr std::size_t longest = 64;
  return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c > ' ' && c != ',' && c != '"' && c != '/';
  });
}

// The least number from 1 that no row has.
long long first_missing(const CsvFile& file, std::size_t dof) {
  std::set<long long> known;
  for (const CsvFile::Row& row : file.rows)
    if (const auto number = whole_number(row.cells[dof])) known.insert(*number);
  long long missing = 1;
  while (known.count(missing) != 0) ++missing;
  return missing;
}

}  // namespace

DofTable read_dof_table(std::string_view content, const std::string& name) {
  const CsvFile file = read_csv(content, name);
  const std::size_t dof = file.column("dof"), node = file.column("node"), component = file.column("component"),
                    held = file.column("held");
  const std::array<std::size_t, 3> axes = {file.column("x"), file.column("y"), file.column("z")};
  const std::size_t count = file.rows.size();
  DofTable table;
  table.name = name;
  table.dofs.resize(count);
  std::map<std::pair<std::string, std::string>, int> known;
  std::map<std::string, const DofName*> nodes;
  for (const CsvFile::Row& row : file.rows) {
    const auto number = whole_number(row.cells[dof]);
    if (!number || *number < 1)
      file.fail(row, fmt::format("\"{}\" for dof; expected a whole number from 1", shortened(row.cells[dof])));
    if (static_cast<std::size_t>(*number) > count)
      file.fail(row, fmt::format("dof {} of a table of {}; expected 1 to {}, each once: {} is missing", *number, count,
                                 count, first_missing(file, dof)));
    DofName& one = table.dofs[static_cast<std::size_t>(*number) - 1];
    if (one.dof != 0) file.fail(row, fmt::format("dof {} stands a second time", *number));
    one.dof = static_cast<int>(*number);
    one.node = row.cells[node];
    one.component = row.cells[component];
    one.held = row.cells[held];
    for (const auto& [text, what] : {std::pair(&one.node, "node"), {&one.component, "component"}})
      if (!is_name(*text))
        file.fail(row, fmt::format("\"{}\" for {}; expected a word without spaces", shortened(*text), what));
    if (!one.held.empty() && !is_name(one.held))
      file.fail(row,
                fmt::format("\"{}\" for held; expected nothing, fixed or the name of a support", shortened(one.held)));
    for (std::size_t axis = 0; axis < axes.size(); ++axis) one.place[axis] = file.number(row, axes[axis]);
    const auto [first, fresh] = known.emplace(std::pair(one.node, one.component), one.dof);
    if (!fresh) file.fail(row, fmt::format("{} is dof {} and dof {}", one.text(), first->second, one.dof));
    const auto [other, new_node] = nodes.emplace(one.node, &one);
    if (!new_node && other->second->place != one.place)
      file.fail(row, fmt::format("node {} has two places; expected the same x, y, z in its rows", one.node));
  }
  // Each number is at most the count and stands once: none is missing.
  if (count == 0) throw FileError(name + " has no dofs; expected one row per row of the matrices");
  return table;
}

}  // namespace ricochet
