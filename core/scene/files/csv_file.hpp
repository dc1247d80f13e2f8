#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace ricochet {

/// A table in CSV: a header, then one row per line, cells separated by commas, spaces around them left out, no quotes.
/// Empty lines say nothing.
struct CsvFile {
  struct Row {
    long line = 0;
    std::vector<std::string> cells;  ///< as many as columns
  };
  std::string name;
  std::vector<std::string> columns;
  std::vector<Row> rows;

  /// Number of a column. Throws FileError with the nearest column where there is none.
  std::size_t column(const std::string& key) const;
  /// Throws FileError: "NAME, line N: what".
  [[noreturn]] void fail(const Row& row, const std::string& what) const;
  /// A finite number in a cell; FileError where it is none.
  double number(const Row& row, std::size_t column) const;
};

/// Reads a table. Throws FileError for no header, a column given twice, a row with too few or too many cells, quotes.
CsvFile read_csv(std::string_view content, const std::string& name);

}  // namespace ricochet
