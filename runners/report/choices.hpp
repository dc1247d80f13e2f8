#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "runners/store/record_values.hpp"

/// \file
/// What tells the cases of a study apart, as sentences, tables and figures speak of it.
namespace ricochet {

/// Whether a column is refined rather than chosen: step, steps_per_period, elements, modes.
bool is_refinement(const std::string& column);

/// The value of an axis of a case as text, "" where the case has none.
std::string axis_words(const CaseRecord& record, std::string_view column);
/// The same of a cell that a table has of it.
std::string axis_words(const Cell& cell);

/// What a short label puts before a value: the last part of the column and a blank; "" for a method's own name.
std::string label_word(const std::string& column);

/// Cases that agree in some axes.
struct CaseGroup {
  std::string label;
  Cases cases;
};

/// A study as a comparison. A *role* is a method's name with its parameters: "mass" stands for the columns mass,
/// mass.velocity, … A *choice* is a role, or an axis of the scene. A *method* is one level of every choice that varies.
/// What is left of a case is its step and its mesh. Cases are those of the results, by their address.
class Choices {
 public:
  explicit Choices(const StudyResults& results);

  const StudyResults& results() const { return results_; }
  /// What the study asks to be compared: a choice or one of its columns; "" where it asks for none.
  const std::string& asked() const { return asked_; }
  /// Columns in which two methods differ, in the study's order; one that a case has and another has not is among them.
  const std::vector<std::string>& varying() const { return varying_; }
  bool varies(std::string_view column) const;
  /// But for these columns or roles.
  std::vector<std::string> varying_without(const std::vector<std::string>& columns) const;
  /// Columns that have one value in every case, as "column value".
  std::vector<std::string> constants() const;
  /// Columns of choices that vary, in the study's order, and the choices that they belong to.
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::string>& choices() const { return choices_; }
  const std::vector<std::string>& columns_of(const std::string& choice) const;
  /// Choices that are no methods.
  std::vector<std::string> scene_columns() const;

  /// The values of a column as texts, in order of appearance; cases without the column do not count.
  const std::vector<std::string>& values(const std::string& column) const;
  /// The place of the case's value among these; nothing where it has none.
  std::optional<std::size_t> place(const CaseRecord& record, const std::string& column) const;
  /// The value of a column as text; "" where the case has none.
  const std::string& text(const CaseRecord& record, const std::string& column) const;
  /// Tells methods apart.
  std::string key(const CaseRecord& record) const;
  std::string key(const CaseRecord& record, const std::vector<std::string>& columns) const;

  /// The case's level of a choice, by what tells it from the others: "singular P1", "Dumont–Paoli β = ½".
  std::string level(const CaseRecord& record, const std::string& choice) const;
  /// The method of the case by its levels of these choices (all): "singular P1, rigid stops"; "" where nothing varies.
  std::string label(const CaseRecord& record) const { return label(record, choices_); }
  std::string label(const CaseRecord& record, const std::vector<std::string>& choices) const;
  /// The same as a sentence says it: "Dumont–Paoli β = ½ on the singular P1 mass with rigid stops"; never empty.
  std::string name(const CaseRecord& record) const { return name(record, choices_); }
  std::string name(const CaseRecord& record, const std::vector<std::string>& choices) const;

  /// The case's values of these columns, those of one role together: "singular P1, stiffness 1e8 N/m".
  std::string words(const CaseRecord& record, const std::vector<std::string>& columns) const;

  /// A value of a column in words: "β = ½", "stiffness 1e6 N/m", "viscosity 1e-4 s", "implicit"; "strap stiffness
  /// 1e4 N/m" where another choice has the same word.
  std::string value_words(const std::string& column, const std::string& value) const;
  /// A choice in a sentence, with the stop or the body that it is of: "the upper stop at plate".
  std::string spoken(const std::string& choice) const;
  /// A table by its number among those of the study: "unloading table 2"; of one alone, "unloading table".
  std::string table_words(const std::string& column, const std::string& value) const;
  /// A method's or a mass matrix's own word: "rigid stops" of "signorini".
  std::string method_words(const std::string& role, const std::string& name) const;
  /// The unit of a column as the study keeps it; "" for words, ratios and counts.
  const std::string& unit_of(const std::string& column) const;
  /// A number of a column with as many digits as tell its levels apart, four at least: "0.01", "0.010002".
  std::string number_words(const std::string& column, double value) const;
  /// Numbers of a column over all cases, ascending, each once.
  const std::vector<double>& numbers_of(const std::string& column) const;

  /// Size of the step: h (s), or the share of a period; nothing where the study refines no step.
  std::optional<double> step(const CaseRecord& record) const;
  /// Size of the mesh: the elements, or the modes where these vary.
  std::optional<double> elements(const CaseRecord& record) const;
  /// Whether a has a finer mesh than b, or the same and a smaller step; of modes on several meshes more elements count.
  bool finer(const CaseRecord& a, const CaseRecord& b) const;
  /// The column of that size.
  std::string mesh_column() const { return varies("modes") ? "modes" : "elements"; }
  /// "20 elements", "8 modes", "all dofs".
  std::string mesh_words(double size) const;
  /// Whether it has the most elements; where modes do not vary, always.
  bool on_finest_mesh(const CaseRecord& record) const;
  /// "h = 1e-6 s", "4000 steps per period".
  std::string step_words(double step) const;

  /// A short label of a case out of these columns (all that vary): "singular, velocity P1 · beta 0.25"; only what
  /// varies is said.
  std::string short_label(const CaseRecord& record, const std::vector<std::string>& columns) const;
  std::string short_label(const CaseRecord& record) const { return short_label(record, varying_); }
  /// The same, never empty: "the one method" where nothing varies.
  std::string short_name(const CaseRecord& record, const std::vector<std::string>& columns) const;
  std::string short_name(const CaseRecord& record) const { return short_name(record, varying_); }
  /// Cases grouped by the values of `columns`, in order of appearance, with these as short labels.
  std::vector<CaseGroup> group(const Cases& cases, const std::vector<std::string>& columns) const;
  /// The short name of the case of this id; the id where there is none.
  std::string name_of(const std::string& id) const;
  /// The case of this id, as a table names it; null where there is none.
  const CaseRecord* find(std::string_view id) const;
  /// What sets some of these cases apart from all: "all 24 cases", "12 of 24 cases (mass singular)".
  std::string describe(const Cases& cases) const;

  /// Mass matrices with every parameter that varies, in order of appearance.
  const std::vector<std::string>& masses() const { return masses_; }
  /// The place of the case's mass matrix among these; their number where it has none (a reference).
  std::size_t mass_place(const CaseRecord& record) const;
  /// Colour of the case's mass matrix, the same in all charts (Okabe and Ito 2008: distinct for colour-blind readers).
  std::string colour(const CaseRecord& record) const;

 private:
  static constexpr int fewest_digits = 4;
  /// What cases have in a column.
  struct Values {
    std::vector<std::string> texts;  // each once
    std::vector<std::string> words;  // of each, value_words()
    std::string role;                // the column itself where it is of none
    std::vector<std::size_t> at;     // of each case, its place among the texts
    std::vector<double> numbers;     // ascending, each once
    int digits = fewest_digits;      // that tell these apart
    std::string unit;
  };
  const Values* known(const std::string& column) const;
  /// The words of the case's value in a column; "" where it has none.
  const std::string& said(const CaseRecord& record, const std::string& column) const;
  const std::string& role_of(const std::string& column) const;
  /// Whether cases of this method differ in a column.
  bool differs(const std::string& column, const std::string& method) const;
  std::string owner(const std::string& column) const;
  std::string own_words(const std::string& column, const std::string& value) const;
  std::string unit_after(const std::string& column) const;
  std::string mass_label(const CaseRecord& record) const;

  const StudyResults& results_;
  std::string asked_;
  std::map<std::string, Values> values_;
  std::vector<std::string> varying_, columns_, choices_, masses_;
  std::map<std::string, std::vector<std::string>> columns_of_;  // of choices, and of their columns
  std::string steps_;                                           // the column of steps
  std::map<std::string, std::set<std::string>> differs_in_;     // column → methods whose cases differ there
};

/// The columns that are not among `own`.
std::vector<std::string> without(std::vector<std::string> columns, const std::vector<std::string>& own);

/// A choice in a sentence: "the mass matrix", "restitution" of "time.restitution".
std::string spoken(const std::string& choice);
/// "the singular P1 mass" of its level; other levels as they are.
std::string level_phrase(const std::string& choice, const std::string& level);

}  // namespace ricochet
