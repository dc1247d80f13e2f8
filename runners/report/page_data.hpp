#pragma once
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace ricochet::report
