#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

/// A name and a unit, for axes, headers and tooltips.
struct Quantity {
  std::string name, unit;
};

/// A unit as it is shown: "" for "1".
std::string shown_unit(const std::string& unit);

/// "name (unit)", without the unit where it is "1" or unknown.
std::string with_unit(const Quantity& quantity);

/// Cases that agree in some axes.
struct CaseGroup {
  std::string label;
  Cases cases;
};

/// The cases of a study as a report speaks of them: which axes vary, short labels, groups, one colour per mass matrix.
/// A *role* is a method's name with its parameters: "mass" stands for the columns mass, mass.velocity, …
class CaseView {
 public:
  explicit CaseView(const StudyResults& results);

  const StudyResults& results() const { return results_; }
  /// Axis columns with more than one value over the cases, in the study's order.
  const std::vector<std::string>& varying() const { return varying_; }
  bool varies(std::string_view column) const;
  /// Distinct values of a column as texts, in order of appearance; cases without the column do not count.
  const std::vector<std::string>& values(const std::string& column) const;
  /// Unit of an axis column as the study keeps it; "" for words, ratios and counts.
  const std::string& unit_of(const std::string& column) const;
  /// Columns that have one value in every case, as "column value".
  std::vector<std::string> constants() const;

  /// The value of a column as text, "" where the case has none.
  static std::string text(const CaseRecord& record, std::string_view column);
  static std::optional<double> number(const CaseRecord& record, const std::string& column) {
    return axis(record, column).number();
  }

  /// Short label of a case out of some columns: "singular, velocity P1 · beta 0.25"; only what varies is said.
  std::string label(const CaseRecord& record, const std::vector<std::string>& columns) const;
  /// Label out of every varying column.
  std::string label(const CaseRecord& record) const { return label(record, varying_); }
  /// The same, never empty: "the one method" where nothing varies.
  std::string name(const CaseRecord& record, const std::vector<std::string>& columns) const;
  std::string name(const CaseRecord& record) const { return name(record, varying_); }
  /// The name of the case of this id; the id where there is none.
  std::string name_of(const std::string& id) const;
  /// The mass matrix with every parameter that varies; never empty where the study has a mass.
  std::string mass_label(const CaseRecord& record) const;
  /// Mass matrices in order of appearance.
  const std::vector<std::string>& masses() const { return masses_; }
  /// Colour of the case's mass matrix, the same in all charts (Okabe and Ito 2008: distinct for colour-blind readers).
  std::string colour(const CaseRecord& record) const;

  /// Varying columns but for those of the given columns or roles.
  std::vector<std::string> varying_without(const std::vector<std::string>& roles) const;
  /// Cases grouped by the values of `columns`, in order of appearance, labelled by them.
  std::vector<CaseGroup> group(const Cases& cases, const std::vector<std::string>& columns) const;
  /// The case of this id, as a table names it; null where there is none.
  const CaseRecord* find(std::string_view id) const;
  /// All cases, and those with a status.
  Cases all() const { return all_cases(results_); }
  Cases with_status(const std::string& status) const { return ricochet::with_status(all(), status); }

  /// What sets some of these cases apart from all: "all 24 cases", "12 of 24 cases (mass singular)".
  std::string describe(const Cases& cases) const;
  /// What sets `cases` apart from `among` in some columns, without the count: "mass singular; time.beta 0.25"; "" where
  /// nothing does.
  static std::string set_apart(const Cases& cases, const Cases& among, const std::vector<std::string>& columns);

 private:
  static constexpr std::size_t no_value = static_cast<std::size_t>(-1);
  /// The values of a column as texts, in order of appearance, which of them each case has, and their unit.
  struct Values {
    std::vector<std::string> texts;
    std::vector<std::size_t> at;
    std::string unit;
  };
  /// Those that some of the cases have, as they are met.
  std::vector<std::string> values_of(const Cases& cases, const std::string& column) const;

  const StudyResults& results_;
  std::map<std::string, Values> values_;
  std::vector<std::string> varying_, masses_;
};

/// The role of a column: "mass" of "mass.velocity"; the column itself where it belongs to no method.
std::string role_of(std::string_view column);

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
