#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runners/table/table.hpp"

namespace ricochet {

/// What a cell holds, as the type of a member; a cell of another kind is absent. Absent texts are "".
template <class Value>
struct CellValue;
template <>
struct CellValue<double> {
  static std::optional<double> of(const Cell& cell) { return cell.number(); }
};
template <>
struct CellValue<int> {
  static std::optional<int> of(const Cell& cell) {
    const auto number = cell.number();
    return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
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
template <class Value>
struct CellValue<std::optional<Value>> {
  static std::optional<std::optional<Value>> of(const Cell& cell) { return CellValue<Value>::of(cell); }
};

/// The columns of a table, each with the member of `Record` that it shows. The one declaration writes rows and reads
/// them back. Members are double, int, bool, std::string, or an optional of one.
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

  const std::vector<Column>& columns() const { return columns_; }

  Row row(const Record& record) const {
    Row row;
    row.reserve(fields_.size());
    for (const Field& field : fields_) row.push_back(field.write(record));
    return row;
  }

  /// All rows of a table. A column that the table lacks leaves its member as a new record has it.
  std::vector<Record> read(const Table& table) const {
    std::vector<std::pair<std::size_t, const Field*>> found;
    for (std::size_t k = 0; k < fields_.size(); ++k)
      if (const auto place = find_column(table.columns, columns_[k].name)) found.emplace_back(*place, &fields_[k]);
    std::vector<Record> records(table.rows.size());
    for (std::size_t r = 0; r < records.size(); ++r)
      for (const auto& [place, field] : found) field->read(records[r], table.rows[r][place]);
    return records;
  }

 private:
  struct Field {
    Write write;
    Read read;
  };
  std::vector<Column> columns_;
  std::vector<Field> fields_;
};

}  // namespace ricochet
