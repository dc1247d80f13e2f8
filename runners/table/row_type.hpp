#pragma once
#include <concepts>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runners/table/table.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {

/// What a cell holds, as the type of a member; a cell of another kind is absent. Absent texts are "".
template <class Value>
struct CellValue;
template <>
struct CellValue<double> {
  static std::optional<double> of(const Cell& cell) { return cell.number(); }
};
template <std::integral Whole>
struct CellValue<Whole> {
  static std::optional<Whole> of(const Cell& cell) {
    const auto number = cell.number();
    return number ? std::optional(static_cast<Whole>(*number)) : std::nullopt;
  }
};
template <>
struct CellValue<bool> {
  static std::optional<bool> of(const Cell& cell) { return cell.truth(); }
};
template <>
struct CellValue<std::string> {
  static std::optional<std::string> of(const Cell& cell) { return cell.text(); }
};
template <>
struct CellValue<Cell> {
  static std::optional<Cell> of(const Cell& cell) { return cell; }
};
template <class Value>
struct CellValue<std::optional<Value>> {
  static std::optional<std::optional<Value>> of(const Cell& cell) { return CellValue<Value>::of(cell); }
};

/// The columns of a table, each with the member of `Record` that it shows. The one declaration writes rows and reads
/// them back. Members are double, whole numbers, bool, std::string, an optional of one, or Cell.
template <class Record>
class RowType {
 public:
  using Write = std::function<Cell(const Record&)>;
  using Read = std::function<void(Record&, const Cell&)>;

  RowType& add(Column column, Write write, Read read) {
    columns_.push_back(std::move(column));
    fields_.push_back({std::move(write), std::move(read)});
    return *this;
  }
  template <class Value, class Owner>
  RowType& add(Column column, Value Owner::*member) {
    return add(
        std::move(column), [member](const Record& record) { return Cell(record.*member); },
        [member](Record& record, const Cell& cell) {
          if (auto value = CellValue<Value>::of(cell)) record.*member = std::move(*value);
        });
  }

  /// The column `case` in front of rows that speak of one case: read alone, as add_row() writes it with the axes.
  template <class Owner>
  RowType& of_case(std::string Owner::*id) {
    return in_front(case_name, [id](Record& record, const Cell& cell) { record.*id = cell.text(); });
  }
  /// Another column that is read alone.
  RowType& in_front(std::string name, Read read) {
    in_front_.emplace_back(std::move(name), std::move(read));
    return *this;
  }

  const std::vector<Column>& columns() const { return columns_; }

  Row row(const Record& record) const {
    Row row;
    row.reserve(fields_.size());
    for (const Field& field : fields_) row.push_back(field.write(record));
    return row;
  }

  /// All rows of a table. A column that the table lacks leaves its member as a new record has it.
  std::vector<Record> read(const Table& table) const {
    std::vector<Record> records;
    records.reserve(table.rows.size());
    each(table, [&](std::size_t, Record&& record) { records.push_back(std::move(record)); });
    return records;
  }
  /// Calls `use(row, Record&&)` with one row after the other: a table may have a million.
  template <class Use>
  void each(const Table& table, Use use) const {
    std::vector<std::pair<std::size_t, const Read*>> found;
    for (const auto& [name, read] : in_front_)
      if (const auto place = find_column(table.columns, name)) found.emplace_back(*place, &read);
    for (std::size_t k = 0; k < fields_.size(); ++k)
      if (const auto place = find_column(table.columns, columns_[k].name)) found.emplace_back(*place, &fields_[k].read);
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      Record record;
      for (const auto& [place, read] : found) (*read)(record, table.rows[r].at(place));
      use(r, std::move(record));
    }
  }
  /// Changes rows in place: `use(Record&)` says whether a row stays. Cells of members that it leaves keep what they
  /// hold.
  template <class Use>
  void change(Table& table, Use use) const {
    std::vector<Row> kept;
    each(table, [&](std::size_t r, Record&& record) {
      const Row before = row(record);
      if (!use(record)) return;
      const Row after = row(record);
      for (std::size_t k = 0; k < columns_.size(); ++k)
        if (!(after[k] == before[k]))
          if (const auto place = find_column(table.columns, columns_[k].name)) table.rows[r].at(*place) = after[k];
      kept.push_back(std::move(table.rows[r]));
    });
    table.rows = std::move(kept);
  }

 private:
  struct Field {
    Write write;
    Read read;
  };
  std::vector<Column> columns_;
  std::vector<Field> fields_;
  std::vector<std::pair<std::string, Read>> in_front_;
};

/// A table whose rows are of one type: NAME.csv, and what a row stands for, one sentence.
template <class Record>
struct TableType {
  std::string name, text;
  RowType<Record> rows;

  /// Without rows.
  Table head() const { return {name, text, rows.columns(), {}}; }
  Table with(const std::vector<Record>& records) const {
    Table table = head();
    for (const Record& record : records) table.rows.push_back(rows.row(record));
    return table;
  }
  const Table* find(const std::vector<Table>& tables) const { return find_table(tables, name); }
  /// The rows of the table of this name; none where it is not among them.
  std::vector<Record> read(const std::vector<Table>& tables) const {
    const Table* table = find(tables);
    return table ? rows.read(*table) : std::vector<Record>();
  }
};

}  // namespace ricochet
