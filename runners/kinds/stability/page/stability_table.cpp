#include <fmt/format.h>

#include "runners/kinds/stability/page/page.hpp"
#include "runners/report/html.hpp"
#include "runners/report/html_table.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

std::string limit_text(const TableReader& rows, size_t row, const char* limit, const char* where) {
  if (const auto step = rows.number(row, limit)) return number_text(*step, 5);
  const std::string said = rows.text(row, where);
  return said.empty() ? "–" : said;
}

/// Marginal roots, then what grows at the smallest step that is not stable, or why there is no prediction; what was
/// seen there is left to the map.
std::string why(const TableReader& rows, size_t row) {
  std::string out = rows.text(row, "marginal");
  const std::string grows = rows.text(row, "grows");
  const auto step = rows.number(row, "first_unstable");
  if (grows.empty() || !step) return out;
  return out + (out.empty() ? "" : "; ") +
         (rows.truth(row, "refused") == true ? grows : fmt::format("h = {} s: {}", number_text(*step, 3), grows));
}

/// "Where a limit is both predicted and observed, 4 of 30 agree to 2 %."
std::string agreement_text(const StudyResults& results) {
  const Table* agreement = find_table(results.derived, "step_limit_agreement");
  if (!agreement || agreement->rows.empty()) return "";
  const TableReader rows(*agreement);
  const size_t both = rows.size() - 1;
  const auto count = [&](const char* column) { return static_cast<size_t>(rows.number(both, column).value_or(0)); };
  std::string out = fmt::format("{} of steps.", count_text(count("ranges"), "range", "ranges"));
  if (count("limits") > 0)
    out += fmt::format(" Where a limit is both predicted and observed, {} of {} agree to {}.", count("agree"),
                       count("limits"), share_text(rows.number(both, "tolerance").value_or(0)));
  if (count("disagree") > 0)
    out += fmt::format(
        " In {} the marches and the spectra disagree at some step: contacts that open and close make "
        "energy that no spectrum of a fixed contact set shows, and growth may need longer than the "
        "horizon.",
        count_text(count("disagree"), "range", "ranges"));
  return out;
}

}  // namespace

std::string stability_html(const CaseView& view) {
  const Table* limits = find_table(view.results().derived, "step_limits");
  if (!limits) return "";
  const TableReader rows(*limits);
  HtmlTable table(
      "Step limits in seconds. Open: the structure alone. Closed: predicted with points held on both sides, the worst "
      "of several sets; observed in the scene itself, which is open as well: the ratio is to the smaller of both "
      "predictions.",
      {{"method"},
       {"contact"},
       {"predicted limit", true},
       {"observed limit", true},
       {"observed / predicted", true},
       {"marginal roots, and what grows at the first step that is not stable"}});
  for (size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* record = view.find(rows.text(row, "case"));
    if (!record || rows.truth(row, "counted") != true) continue;
    const bool closed = rows.truth(row, "closed") == true;
    const auto columns = closed ? view.varying() : view.varying_without({"contact"});
    const auto ratio = rows.number(row, "ratio");
    table.row(view.name(*record, columns), view.colour(*record)).text(closed ? "closed" : "open");
    table.number(limit_text(rows, row, "predicted", "prediction"));
    table.number(limit_text(rows, row, "observed", "observation"));
    table.number(ratio ? number_text(*ratio, 4) : "–").text(why(rows, row), "reason");
  }
  if (table.size() == 0) return "";
  return "<p class=\"lead\">" + agreement_text(view.results()) + "</p>\n" + table.html();
}

}  // namespace ricochet::report
