#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/report/case_view.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

/// A derived table as a report reads it: cells by column name, rows found by the axes of a case.
class AxisRows {
 public:
  /// `keys`: columns that tell rows of the same axes apart, such as "error".
  AxisRows(const StudyResults& results, std::string_view table, std::vector<std::string> keys = {});

  size_t size() const { return rows_ ? rows_->size() : 0; }
  bool empty() const { return size() == 0; }
  /// The cell as text, "" for null and for a column that the table does not have.
  std::string text(size_t row, std::string_view column) const;
  std::optional<double> number(size_t row, std::string_view column) const;
  /// The cell itself, nothing for a column that the table does not have.
  Cell value(size_t row, std::string_view column) const;
  bool flag(size_t row, std::string_view column) const;
  /// Distinct texts of a column, in order of appearance.
  std::vector<std::string> values(std::string_view column) const;

  /// Columns that are axes of the study.
  const std::vector<std::string>& axes() const { return axes_; }
  /// The row with the case's axes (empty cells match cases without a value; `but` is not looked at) and these keys.
  std::optional<size_t> find(const CaseRecord& record, const std::vector<std::string>& keys,
                             const std::vector<std::string>& but = {}) const;
  /// A case that has the row's axes, to say it by its label; nothing where there is none.
  const CaseRecord* example(size_t row, const StudyResults& results) const;

 private:
  std::optional<TableReader> rows_;
  std::vector<std::string> axes_, keys_;
  std::map<std::string, size_t> places_;
};

/// A kind of error with its unit; "1" where the unit depends on the structure.
Quantity error_quantity(const std::string& error);

/// An order of convergence with two decimals: "1.00", "−0.03".
std::string order_number(double order);

/// 1e-3 as "10⁻³"; other numbers as they are.
std::string power_text(double value);

}  // namespace ricochet::report
