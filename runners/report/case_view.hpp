#pragma once
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record_values.hpp"
#include "runners/table/row_type.hpp"

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

/// The name of an axis as it is read: of a stop of a list with the name of that, "stiffness of bar-a".
std::string axis_text(const StudyResults& results, const std::string& column);

/// The cases of a study as a report speaks of them: which axes vary, short labels, groups, the place of a mass matrix.
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
  /// The place of the case's mass matrix among these; their number where it has none (a reference).
  std::size_t mass_place(const CaseRecord& record) const;
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
  Cases with_status(Status status) const { return ricochet::with_status(all(), status); }

  /// What sets some of these cases apart from all: "all 24 cases", "12 of 24 cases (mass singular)".
  std::string describe(const Cases& cases) const;

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

/// What a label puts before a value: the last part of the column and a blank; "" for a method's own name.
std::string label_word(const std::string& column);

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

/// A kind of error with its unit; "1" where the unit depends on the structure.
Quantity error_quantity(const std::string& error);

/// An order of convergence with two decimals: "1.00", "−0.03".
std::string order_number(double order);

/// 1e-3 as "10⁻³"; other numbers as they are.
std::string power_text(double value);

}  // namespace ricochet::report
