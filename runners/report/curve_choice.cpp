#include "runners/report/curve_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/store/curve_files.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

constexpr std::size_t most_curve_rows = 24, most_curve_cases = 96, at_an_end = 8;

/// The measure that the answer speaks of first; "" where it speaks of none.
std::string answered_measure(const StudyResults& results) {
  const Table* answers = find_table(results.derived, "answers");
  if (!answers || answers->rows.empty()) return "";
  const TableReader rows(*answers);
  return rows.text(0, "measure");
}

/// Places of `count` groups: both ends of what is measured, then evenly over all.
std::set<std::size_t> chosen(const std::vector<CaseGroup>& groups, const std::string& name) {
  std::vector<std::pair<double, std::size_t>> known;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const CaseRecord* record : groups[g].cases)
      if (const auto value = ricochet::measure(*record, name); value && record->status == "done")
        known.emplace_back(*value, g);
  std::sort(known.begin(), known.end());
  std::set<std::size_t> out;
  for (std::size_t k = 0; k < known.size() && out.size() < at_an_end; ++k) out.insert(known[k].second);
  for (std::size_t k = known.size(); k > 0 && out.size() < 2 * at_an_end; --k) out.insert(known[k - 1].second);
  const std::size_t even = most_curve_rows - out.size();
  for (std::size_t k = 0; k < even; ++k) out.insert(k * groups.size() / even);
  return out;
}

}  // namespace

CurveChoice::CurveChoice(const CaseView& view, const StudyResults& all) {
  Cases drawn;
  for (const CaseRecord* record : view.all())
    if (!record->curve.columns.empty()) drawn.push_back(record);
  with_curves_ = drawn.size();
  files_ = has_curve_files(all);
  where_ = where_curves_are(all);
  const std::vector<CaseGroup> groups = view.group(drawn, view.varying_without({"step"}));
  all_ = groups.size() <= most_curve_rows || drawn.size() <= most_curve_cases;
  if (all_) return;
  for (const std::size_t place : chosen(groups, answered_measure(view.results())))
    for (const CaseRecord* record : groups[place].cases) ids_.insert(record->id);
}

std::string CurveChoice::sentence() const {
  if (all_) return files_ ? "" : fmt::format("Curves over time: {}.", where_);
  return fmt::format(
      "Curves over time: this page holds those of {} of {} cases, the extreme ones and others spread over the study; "
      "{}.",
      ids_.size(), with_curves_, where_);
}

}  // namespace ricochet::report
