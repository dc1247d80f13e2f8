#pragma once
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runners/store/record_values.hpp"
#include "runners/table/row_type.hpp"

namespace ricochet::report {

/// Which rows of a derived table have the axes of a case.
class AxisPlaces {
 public:
  /// `keys`: of each row, what tells it from others of the same axes, such as the error.
  AxisPlaces(const StudyResults& results, const Table* table, const std::vector<std::vector<std::string>>& keys);

  /// Columns that are axes of the study.
  const std::vector<std::string>& axes() const { return axes_; }
  /// The cells of these columns.
  const Row& cells(size_t row) const { return cells_[row]; }
  /// Such a cell as a text, "" where the row has none.
  std::string axis_text(size_t row, size_t axis) const;
  /// The row with the case's axes (empty cells match cases without a value; `but` is not looked at) and these keys.
  std::optional<size_t> find(const CaseRecord& record, const std::vector<std::string>& keys,
                             const std::vector<std::string>& but = {}) const;
  /// A case that has the row's axes, to say it by its label; nothing where there is none.
  const CaseRecord* example(size_t row, const StudyResults& results) const;

 private:
  std::vector<std::string> axes_;
  std::vector<Row> cells_;
  std::map<std::string, size_t> places_;
};

/// The rows of a derived table, found by the axes of a case.
template <class Record>
class AxisRows : public AxisPlaces {
 public:
  using Keys = std::vector<std::string> (*)(const Record&);
  AxisRows(const StudyResults& results, const TableType<Record>& type, Keys keys = nullptr)
      : AxisRows(results, type.find(results.derived), type.read(results.derived), keys) {}

  size_t size() const { return rows_.size(); }
  bool empty() const { return rows_.empty(); }
  const Record& operator[](size_t row) const { return rows_[row]; }
  auto begin() const { return rows_.begin(); }
  auto end() const { return rows_.end(); }
  /// Distinct values of a member, in order of appearance.
  std::vector<std::string> values(std::string Record::*member) const {
    std::vector<std::string> out;
    for (const Record& row : rows_)
      if (std::find(out.begin(), out.end(), row.*member) == out.end()) out.push_back(row.*member);
    return out;
  }

 private:
  AxisRows(const StudyResults& results, const Table* table, std::vector<Record> rows, Keys keys)
      : AxisPlaces(results, table, keys_of(rows, keys)), rows_(std::move(rows)) {}
  static std::vector<std::vector<std::string>> keys_of(const std::vector<Record>& rows, Keys keys) {
    std::vector<std::vector<std::string>> out(rows.size());
    for (size_t k = 0; keys && k < rows.size(); ++k) out[k] = keys(rows[k]);
    return out;
  }
  std::vector<Record> rows_;
};

}  // namespace ricochet::report
