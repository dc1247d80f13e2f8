#pragma once
#include <stdexcept>

#include "runners/table/table.hpp"

namespace ricochet {

/// A table lacks a column that its reader needs; the text names both.
class TableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the rows of a table: a column is found once by its name, then asked row after row. The table outlives it.
class TableReader {
 public:
  /// A place that no column has: its cells are nothing.
  static constexpr std::size_t absent = static_cast<std::size_t>(-1);

  explicit TableReader(const Table& table) : table_(&table) {}

  std::size_t size() const { return table_->rows.size(); }
  const Table& table() const { return *table_; }

  /// Where the column stands. Throws TableError where there is none.
  std::size_t column(std::string_view name) const;
  /// The same for a column that not every such table has: `absent` where there is none.
  std::size_t column_if_any(std::string_view name) const;

  /// The cell; nothing where the column is absent.
  const Cell& cell(std::size_t row, std::size_t column) const;
  std::optional<double> number(std::size_t row, std::size_t column) const { return cell(row, column).number(); }
  std::optional<bool> truth(std::size_t row, std::size_t column) const { return cell(row, column).truth(); }
  /// Any cell as text, "" for nothing.
  std::string text(std::size_t row, std::size_t column) const { return cell(row, column).text(); }

  /// The same by name, for a single look; throws TableError where there is no such column.
  std::optional<double> number(std::size_t row, std::string_view name) const { return number(row, column(name)); }
  std::optional<bool> truth(std::size_t row, std::string_view name) const { return truth(row, column(name)); }
  std::string text(std::size_t row, std::string_view name) const { return text(row, column(name)); }

 private:
  const Table* table_;
};

/// The table of this name; null where there is none.
const Table* find_table(const std::vector<Table>& tables, std::string_view name);
Table* find_table(std::vector<Table>& tables, std::string_view name);

}  // namespace ricochet
