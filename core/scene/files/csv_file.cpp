#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/files/csv_file.hpp>
#include <ricochet/scene/files/text_file.hpp>

namespace ricochet {
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

}  // namespace ricochet
