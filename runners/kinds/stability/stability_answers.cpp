#include <fmt/format.h>

#include <algorithm>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/stability/stability_roots.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

/// "Where a limit is both predicted and observed, 4 of 30 agree to 2 %."
std::string agreement_text(const StudyResults& results) {
  const Table* agreement = find_table(results.derived, "step_limit_agreement");
  if (!agreement || agreement->rows.empty()) return "";
  const TableReader rows(*agreement);
  const size_t both = rows.size() - 1;
  const auto count = [&](const char* column) { return static_cast<size_t>(rows.number(both, column).value_or(0)); };
  std::string out = fmt::format("{} of steps.", report::count_text(count("ranges"), "range", "ranges"));
  if (count("limits") > 0)
    out += fmt::format(" Where a limit is both predicted and observed, {} of {} agree to {}.", count("agree"),
                       count("limits"), report::share_text(rows.number(both, "tolerance").value_or(0)));
  if (count("disagree") > 0)
    out += fmt::format(
        " In {} the marches and the spectra disagree at some step: contacts that open and close make "
        "energy that no spectrum of a fixed contact set shows, and growth may need longer than the "
        "horizon.",
        report::count_text(count("disagree"), "range", "ranges"));
  return out;
}

/// What the ranges of one scheme with its contact open come to, over masses and scenes.
struct SchemeLimits {
  std::size_t ranges = 0, unlimited = 0;
  std::optional<double> least, most;  ///< predicted limits, s
};

}  // namespace

Table stability_answers(const StudyResults& results) {
  Table out = answers_head();
  const Table* limits = find_table(results.derived, "step_limits");
  if (!limits || limits->rows.empty()) return out;
  const TableReader rows(*limits);
  const report::CaseView view(results);
  std::vector<std::string> columns;
  for (const std::string& column : view.varying())
    if (report::role_of(column) == "time") columns.push_back(column);
  std::vector<std::pair<std::string, SchemeLimits>> schemes;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* record = view.find(rows.text(row, "case"));
    if (!record || rows.truth(row, "counted") != true || rows.truth(row, "closed") == true) continue;
    SchemeLimits& scheme = in_order_met(schemes, method_name(view, *record, columns));
    ++scheme.ranges;
    scheme.unlimited += !rows.text(row, "prediction").empty() && !rows.number(row, "first_unstable");
    if (const auto limit = rows.number(row, "predicted")) {
      scheme.least = std::min(scheme.least.value_or(*limit), *limit);
      scheme.most = std::max(scheme.most.value_or(*limit), *limit);
    }
  }
  const auto add = [&](const std::string& verdict, const std::string& sentence) {
    out.rows.push_back(AnswerRow{.choice = "time", .verdict = verdict, .sentence = sentence}.row());
  };
  std::vector<std::string> free, limited;
  for (const auto& [name, scheme] : schemes) {
    if (scheme.unlimited == scheme.ranges) free.push_back(name);
    if (!scheme.least) continue;
    const std::string least = report::number_text(*scheme.least, 3), most = report::number_text(*scheme.most, 3);
    limited.push_back(fmt::format("{} ({}{} s)", name, least, least == most ? "" : " to " + most));
  }
  if (!limited.empty())
    add("limited", fmt::format("Stable without contact up to a largest step: {}.", report::list_text(limited)));
  if (!free.empty())
    add("unlimited", fmt::format("Stable without contact at every step of the range: {}.", report::list_text(free)));
  for (const std::string& sentence : roots_told(results, columns)) add("roots", sentence);
  if (const std::string agreement = agreement_text(results); !agreement.empty()) add("agreement", agreement);
  return out;
}

}  // namespace ricochet
