#pragma once
#include "runners/table/series.hpp"
#include "runners/table/table.hpp"

namespace ricochet {

/// Many numbers in columns of equal length, as they stand in NAME.csv behind the axes of their case: sections, impacts.
/// NaN is an absent number (an empty field).
struct NumberTable {
  std::string name;
  std::vector<Column> columns;
  std::vector<Series> values;  ///< of each of the columns
  /// Columns that hold words: column name, and the words; the numbers are indices into them.
  std::vector<std::pair<std::string, std::vector<std::string>>> words = {};
  bool exported = true;   ///< false: for the report and for going on, not written as CSV
  std::string text = {};  ///< what a row stands for, one sentence

  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  /// Appends a row, a number for each column.
  void add(std::initializer_list<double> row);
  /// A column; null where the table has none of this name.
  const Series* series(std::string_view column) const;
  /// All numbers of a column; null where the table has no such column.
  const std::vector<double>* numbers(std::string_view column) const;
  /// What the numbers of a column stand for; null where they stand for themselves.
  const std::vector<std::string>* words_of(std::string_view column) const;
};

/// An empty table of these columns.
NumberTable number_table(std::string name, std::vector<Column> columns);

/// The table of this name; null where there is none.
const NumberTable* find_table(const std::vector<NumberTable>& tables, std::string_view name);

}  // namespace ricochet
