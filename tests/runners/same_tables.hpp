#pragma once
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/runners/scratch_folder.hpp"

/// \file
/// Tables of two runs of one study, compared as text without what belongs to the machine.
namespace same_tables {

namespace fs = std::filesystem;

/// Measures that belong to the machine.
inline bool of_the_machine(const std::string& column) {
  static const std::set<std::string> names = {"setup_seconds", "run_seconds", "lane_steps_per_second",
                                              "exponent_seconds", "microseconds_per_step"};
  return names.count(column) != 0 || column.starts_with("timed_");
}

using Rows = std::vector<std::map<std::string, std::string>>;

inline Rows rows_of(const fs::path& file) {
  std::istringstream lines(read_text(file));
  std::string line;
  std::vector<std::string> names;
  Rows rows;
  while (std::getline(lines, line)) {
    std::vector<std::string> cells;
    bool quoted = false;
    std::string cell;
    for (const char c : line + ",") {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted) {
        cells.push_back(cell);
        cell.clear();
      } else if (c != '"') {
        cell += c;
      }
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    std::map<std::string, std::string> row;
    // A dictionary has a row for each column that is there.
    bool wanted = true;
    for (std::size_t i = 0; i < names.size() && i < cells.size(); ++i) {
      if (!of_the_machine(names[i])) row[names[i]] = cells[i];
      wanted = wanted && !(names[i] == "column" && of_the_machine(cells[i]));
    }
    if (wanted) rows.push_back(std::move(row));
  }
  return rows;
}

/// The first cell that differs; "" where none does.
inline std::string difference(const Rows& a, const Rows& b) {
  if (a.size() != b.size()) return std::to_string(a.size()) + " rows, " + std::to_string(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    if (a[i].size() != b[i].size()) return "columns";
    for (const auto& [column, cell] : a[i])
      if (b[i].count(column) == 0 || b[i].at(column) != cell)
        return "row " + std::to_string(i) + ", " + column + ": " + cell + " | " +
               (b[i].count(column) ? b[i].at(column) : "no such column");
  }
  return "";
}

/// `work`: the study asks what work costs, so that some of its tables and columns follow from times.
inline void check_same(const fs::path& a, const fs::path& b, bool work = false) {
  static const std::set<std::string> of_work = {"seconds",      "low",      "high",      "run_seconds",
                                                "microseconds", "on_front", "near_front"};
  int tables = 0;
  for (const auto& entry : fs::recursive_directory_iterator(a)) {
    if (entry.path().extension() != ".csv") continue;
    const fs::path name = fs::relative(entry.path(), a);
    INFO(name);
    REQUIRE(fs::exists(b / name));
    if (work && (name == "answers.csv" || name == "verdicts.csv" || name == "precision_targets.csv")) continue;
    Rows rows = rows_of(entry.path()), others = rows_of(b / name);
    if (work)
      for (Rows* all : {&rows, &others})
        for (auto& row : *all) std::erase_if(row, [](const auto& cell) { return of_work.count(cell.first) != 0; });
    CHECK(difference(rows, others) == "");
    ++tables;
  }
  CHECK(tables > 2);
}

}  // namespace same_tables
