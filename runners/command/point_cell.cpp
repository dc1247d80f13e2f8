#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <iostream>

#include "runners/command/command.hpp"
#include "runners/command/stored_case.hpp"
#include "runners/kinds/basins/cell_ends.hpp"
#include "runners/study/with_parameter.hpp"

namespace ricochet {
namespace {

// "X,Y" as two numbers.
std::pair<double, double> two_numbers(const std::string& text) {
  std::pair<double, double> out;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, out.first);
  if (first.ec == std::errc() && first.ptr != end && *first.ptr == ',')
    if (const auto second = std::from_chars(first.ptr + 1, end, out.second);
        second.ec == std::errc() && second.ptr == end)
      return out;
  throw UsageError(fmt::format("--cell \"{}\": expected two numbers X,Y, the values of the study's axes", text));
}

std::size_t find_place(const GridAxis& axis, double wanted) {
  for (std::size_t k = 0; k < axis.values.size(); ++k)
    if (is_value(axis.values[k], wanted)) return k;
  throw UsageError(fmt::format("no cell was marched at {} {}; the nearest values are {}", axis.pointer, wanted,
                               nearest_values(axis.values, wanted)));
}

// The strobed points that the run stored for a row of cells.csv.
std::vector<SectionPoint> stored_section(const CaseRecord& record, std::size_t row) {
  std::vector<SectionPoint> out;
  for (const NumberTable& table : record.numbers)
    for (std::size_t i = 0; table.name == "cell_points" && i < table.rows(); ++i)
      if (table.columns[0][i] == static_cast<double>(row))
        out.push_back({table.columns[2][i], table.columns[3][i], table.columns[4][i], table.columns[5][i]});
  return out;
}

std::string regime_text(const CellEnd& end) {
  if (end.status != "done") return end.status + ": " + end.reason;
  return text(end.motion);
}

}  // namespace

int print_cell(const StudyResults& results, const Arguments& arguments, std::ostream& out) {
  if (arguments.cell.empty() || arguments.parameter || !arguments.start.empty())
    throw UsageError("ricochet point: this is a study of kind basins; expected --cell X,Y, as in cells.csv");
  const auto [x, y] = two_numbers(arguments.cell);
  const CaseRecord& record = find_case(results, arguments.operands[1]);
  const StoredStudy stored(results, arguments);
  const StudyCase& study_case = stored.find(record.id);
  const std::vector<GridAxis> axes = grid_axes(study_case.settings);
  const std::size_t column = find_place(axes[0], x), line = find_place(axes[1], y);
  const StoredRows cells(record, "cells");
  std::size_t row = 0;
  while (row < cells.count() &&
         !(cells.number(row, "x") == axes[0].values[column] && cells.number(row, "y") == axes[1].values[line]))
    ++row;

  SamplePrinter print(out);
  const CellEnd end = march_cell(study_case, stored.registry, {column, line}, wanted_count(arguments), std::ref(print));
  std::cerr << regime_text(end);
  if (row == cells.count()) {
    std::cerr << "; the run has not come to this cell";
  } else if (cells.cell(row, "marched") == false) {
    std::cerr << fmt::format("; the run filled this cell from a marched one of its basin ({})", cells.regime(row));
  } else {
    const std::vector<SectionPoint> section = stored_section(record, row);
    std::size_t equal = 0;
    for (std::size_t i = 0; i < std::min(section.size(), end.section.size()); ++i)
      equal += section[i].displacement == end.section[i].displacement && section[i].velocity == end.section[i].velocity;
    std::cerr << comparison_text(equal, std::max(section.size(), end.section.size()));
  }
  std::cerr << "\n";
  return end.status == "done" ? exit_done : exit_some_failed;
}

}  // namespace ricochet
