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
template <Worded Enum>
struct CellValue<Enum> {
  static std::optional<Enum> of(const Cell& cell) { return of_word<Enum>(cell.text()); }
};
template <>
struct CellValue<Cell> {
  static std::optional<Cell> of(const Cell& cell) { return cell; }
};
template <class Value>
struct CellValue<std::optional<Value>> {
  static std::optional<std::optional<Value>> of(const Cell& cell) { return CellValue<Value>::of(cell); }
};

/// How a value of one type becomes a cell and back. What a cell does not hold stays as it was.
struct CellForm {
  Cell (*write)(const void* value);
  void (*read)(void* value, const Cell& cell);
};
template <class Value>
inline constexpr CellForm cell_form = {[](const void* value) { return Cell(*static_cast<const Value*>(value)); },
                                       [](void* value, const Cell& cell) {
                                         if (auto held = CellValue<Value>::of(cell))
                                           *static_cast<Value*>(value) = std::move(*held);
                                       }};

/// The columns of a table, and where in a record each finds its value, whatever the type of the record is.
class RowFields {
 public:
  const Columns& columns() const { return columns_; }

 protected:
  struct Field {
    const CellForm* form = nullptr;  ///< of the value at `offset`; null: the record is written and read as a whole
    std::size_t offset = 0;
    std::function<Cell(const void* record)> write = {};
    std::function<void(void* record, const Cell& cell)> read = {};
  };
  /// The columns that a table has, with their places in its rows.
  using Places = std::vector<std::pair<std::size_t, const Field*>>;

  void add(Column column, Field field);
  void add_in_front(std::string name, Field field) { in_front_.emplace_back(std::move(name), std::move(field)); }
  Row row_of(const void* record) const;
  Places find(const Table& table) const;
  static void read(const Row& row, const Places& places, void* record);

 private:
  Columns columns_;
  std::vector<Field> fields_;
  std::vector<std::pair<std::string, Field>> in_front_;
};

/// The columns of a table, each with the member of `Record` that it shows. The one declaration writes rows and reads
/// them back. Members are double, whole numbers, bool, std::string, enumerations with words,
/// an optional of one, or Cell.
template <class Record>
class RowType : public RowFields {
 public:
  template <class Value, class Owner>
  RowType& add(Column column, Value Owner::*member) {
    RowFields::add(std::move(column), {&cell_form<Value>, offset_of(member)});
    return *this;
  }
  /// `write(const Record&)` gives the cell, `read(Record&, const Cell&)` takes it.
  template <class Write, class Read>
  RowType& add(Column column, Write write, Read read) {
    RowFields::add(std::move(column),
                   {nullptr, 0, [write](const void* record) { return write(*static_cast<const Record*>(record)); },
                    read_of(std::move(read))});
    return *this;
  }

  /// The column `case` in front of rows that speak of one case: read alone, as add_row() writes it with the axes.
  template <class Owner>
  RowType& of_case(std::string Owner::*id) {
    add_in_front(case_name, {&cell_form<std::string>, offset_of(id)});
    return *this;
  }
  /// Another column that is read alone.
  template <class Read>
  RowType& in_front(std::string name, Read read) {
    add_in_front(std::move(name), {nullptr, 0, {}, read_of(std::move(read))});
    return *this;
  }

  Row row(const Record& record) const { return row_of(&record); }

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
    const Places places = find(table);
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      Record record;
      RowFields::read(table.rows[r], places, &record);
      use(r, std::move(record));
    }
  }

 private:
  template <class Value, class Owner>
  static std::size_t offset_of(Value Owner::*member) {
    static const Record record{};
    return static_cast<std::size_t>(reinterpret_cast<const char*>(&(record.*member)) -
                                    reinterpret_cast<const char*>(&record));
  }
  template <class Read>
  static std::function<void(void*, const Cell&)> read_of(Read read) {
    return [read](void* record, const Cell& cell) { read(*static_cast<Record*>(record), cell); };
  }
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
