#pragma once
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "runners/report/case_view.hpp"
#include "runners/report/kind_page.hpp"

namespace ricochet::report {

/// What the page's script reads: the results as JSON, and long columns of numbers apart, as base64 by "name:type".
struct PageData {
  nlohmann::ordered_json results, blocks;
  std::string thinning;  ///< what was left out of the curves, "" where nothing was
};

/// `results` has
///   study     name, kind, and the resolved study
///   axes      [{name, unit, texts, numbers, at}]: the distinct values of a column, and by case which it has (−1: none)
///   cases     {id, status, reason, partial, steps, setup_seconds, run_seconds, measures: {name: column}}, in columns
///   measures  [{name, unit, text}]
///   tables    {name: {columns: [{name, unit, text}], rows, cells}}: a column of words is {words, at}
///   own       {table: {case: …}}: tables of single cases, in the same form
///   curves    {case: {column: [block of t, block of the column]}}
///   curve_files  whether each case with a curve has its file
///   and what the kind adds under its own key
/// Nothing that figures of the kind do not read is written, but for the cases with their measures.
/// `all`: results of which the view may hold a part; they decide whether there are files of curves.
PageData page_data(const CaseView& view, const KindPage& kind, const StudyResults& all);

/// The cases of which a page holds curves over time: all where they fit the charts of a figure, which are 24 rows of
/// cases that differ in the step alone, or 96 cases. Else 24 such rows. Among them are those with the least and with
/// the most of what the answer speaks of first; the others are spread evenly over the study.
class CurveChoice {
 public:
  CurveChoice(const CaseView& view, const StudyResults& all);
  bool holds(const std::string& id) const { return all_ || ids_.count(id) > 0; }
  /// "Curves over time: this page holds those of 70 of 912 cases …", and where the others are; "" where all are held
  /// and each has its file.
  std::string sentence() const;

 private:
  bool all_ = true;
  std::size_t with_curves_ = 0;
  bool files_ = true;
  std::string where_;
  std::set<std::string> ids_;
};

}  // namespace ricochet::report
