#pragma once
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "runners/report/choices.hpp"
#include "runners/report/curve_data.hpp"
#include "runners/report/kind_page.hpp"
#include "runners/store/record.hpp"

namespace ricochet::report {

/// What the page's script reads: the results as JSON, and long columns of numbers apart, as base64 by "name:type".
struct PageData {
  nlohmann::ordered_json results;
  Blocks blocks;
  std::string thinning;  ///< what was left out of the curves, "" where nothing was
};

/// `results` has
///   study     name, kind, and the resolved study
///   axes      [{name, said, role, word, unit, varies, texts, numbers, at}]: the distinct values of a column, and by
///             case which it has (−1: none); `word` stands before a value in labels
///   roles     the roles of methods
///   masses    labels of mass matrices
///   cases     {id, status, reason, partial, steps, setup_seconds, run_seconds, mass, colour,
///             measures: {name: column}}, in columns; `mass` is a place in masses, none of a reference; `colour` is
///             that of the mass
///   measures  [{name, unit, text}]
///   tables    {name: {columns: [{name, unit, text}], rows, cells}}: a column of words is {words, at}
///   own       {table: {case: …}}: tables of single cases, in the same form
///   curves    {case: {column: [block of t, block of the column]}}
///   curve_files  whether each case with a curve has its file
///   and what the kind adds under its own key
/// The page holds the cases with their measures, and else what figures of the kind read.
/// `all`: results of which the choices may hold a part; they decide whether there are files of curves.
PageData page_data(const Choices& choices, const KindPage& kind, const StudyResults& all);

/// The cases of which a page holds curves over time. All are held where they fit the charts of a figure: 24 rows of
/// cases that differ in the step alone, or 96 cases. Else 24 such rows at most are. Up to 8 are those with the least of
/// what the answer speaks of first, and 8 those with the most. The others are spread evenly over the study.
class CurveChoice {
 public:
  CurveChoice(const Choices& choices, const StudyResults& all);
  bool holds(const std::string& id) const { return all_ || ids_.count(id) > 0; }
  /// "Curves over time: this page holds those of 70 of 912 cases …", and where all are. "" where all are held and each
  /// has its file.
  std::string sentence() const;

 private:
  bool all_ = true;
  std::size_t with_curves_ = 0;
  bool files_ = true;
  std::string where_;
  std::set<std::string> ids_;
};

/// What the panel of a case shows that no figure of the page has, bounded so that the page stays small:
///
///     ledger     columns, and their numbers by case, in six digits
///     impacts    columns, and by case the first rows; the number of all of them is a measure of the case
///     portraits  by case the names of blocks with tip displacement and velocity, a few hundred points of the curve
///
/// Of a study of many cases only the ledger.
nlohmann::ordered_json panel_data(const Choices& choices, CurveData& blocks);

/// The snapshots of the cases that have some, as the player reads them. By case the places, points and stops, the units
/// of the counts and the names of its blocks. Where all of them would make the page big, every second instant of each
/// case, every third, … is left: `stride`. Forces are then the mean over the longer time.
nlohmann::ordered_json snapshot_data(const Choices& choices, CurveData& blocks);

/// All cases with status, reason and every measure: sortable, filterable; units in the header, the measure's text as
/// its tooltip and in a list below. `all`: results of which the choices may hold a part; they decide whether there are
/// files of curves.
std::string case_table_html(const Choices& choices, const StudyResults& all);

/// What `compile` left out of the cases, the same item and reason put together.
std::string left_out_html(const Choices& choices);

/// The notes of the cases, put together.
std::string notes_html(const Choices& choices);

/// Compiler, processor, libraries, and the resolved study.
std::string environment_html(const Choices& choices);

/// The derived tables of the results as folded HTML tables that a click on a header sorts. The first rows of each, and
/// how many more its CSV file has. Empty where nothing was derived.
std::string derived_tables_html(const StudyResults& results);

}  // namespace ricochet::report
