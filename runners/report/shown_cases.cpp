#include "runners/report/shown_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_set>

#include "runners/report/case_view.hpp"

namespace ricochet::report {
namespace {

using Ids = std::unordered_set<std::string>;

Ids chosen(const StudyResults& results) {
  Ids ids;
  std::set<std::pair<std::string, std::string>> met;
  for (const CaseRecord& record : results.cases)
    for (const std::string& column : results.columns)
      if (ids.size() < most_shown_cases / 4 && met.emplace(column, CaseView::text(record, column)).second)
        ids.insert(record.id);
  std::vector<const CaseRecord*> by_lot;
  for (const CaseRecord& record : results.cases) by_lot.push_back(&record);
  std::sort(by_lot.begin(), by_lot.end(), [](const CaseRecord* a, const CaseRecord* b) { return a->id < b->id; });
  std::size_t bad = 0;
  for (const CaseRecord* record : by_lot)
    if (record->status != "done" && bad < most_shown_cases / 4) bad += ids.insert(record->id).second;
  for (const CaseRecord* record : by_lot)
    if (ids.size() < most_shown_cases) ids.insert(record->id);
  return ids;
}

}  // namespace

std::optional<StudyResults> shown_cases(const StudyResults& results) {
  if (results.cases.size() <= 2 * most_shown_cases) return std::nullopt;
  const Ids ids = chosen(results);
  StudyResults shown;
  shown.study = results.study;
  shown.name = results.name;
  shown.question = results.question;
  shown.kind = results.kind;
  shown.columns = results.columns;
  shown.axes = results.axes;
  shown.expected_cases = results.expected_cases;
  shown.part = results.part;
  shown.environment = results.environment;
  for (const CaseRecord& record : results.cases)
    if (ids.contains(record.id)) shown.cases.push_back(record);
  for (const Table& table : results.derived) {
    Table& kept = shown.derived.emplace_back(Table{table.name, table.text, table.columns, {}});
    const bool of_cases = !table.columns.empty() && table.columns.front().name == "case";
    for (const Row& row : table.rows)
      if (!of_cases || ids.contains(row.front().text())) kept.rows.push_back(row);
  }
  return shown;
}

std::string shown_sentence(const StudyResults& shown, const StudyResults& all) {
  return fmt::format(
      "The figures and the table of cases hold {} of {} cases, drawn by lot, and among them first of all those that "
      "are not done, up to {}; what is said in words is of all, and all are in cases.csv.",
      shown.cases.size(), all.cases.size(), most_shown_cases / 4);
}

}  // namespace ricochet::report
