#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "runners/kinds/comparison/precision_targets.hpp"
#include "runners/kinds/work-precision/page/page.hpp"
#include "runners/kinds/work-precision/page/work_precision.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/html_table.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

/// The method of a row under a prefix ("", "other_"), its step, and its time.
void case_cells(HtmlTable& table, const CaseView& view, const TableReader& targets, size_t row,
                std::string_view prefix) {
  const auto column = [&](const char* name) { return std::string(prefix) + name; };
  const CaseRecord* record = view.find(targets.text(row, column("case")));
  if (!record) {
    table.absent(false, "no other").absent(false).absent();
    return;
  }
  std::vector<std::string> methods;
  std::copy_if(view.varying().begin(), view.varying().end(), std::back_inserter(methods), is_method);
  std::string how = exact_text(CaseView::number(*record, "step").value_or(0)) + " s";
  if (view.varies("elements")) how += ", " + CaseView::text(*record, "elements") + " elements";
  const auto seconds = [&](const char* name, int digits) {
    return number_text(targets.number(row, column(name)).value_or(0), digits);
  };
  table.text(view.name(*record, methods)).text(how);
  table.number(seconds("seconds", 3), seconds("low", 4) + " to " + seconds("high", 4) + " s");
}

}  // namespace

std::string work_precision_html(const CaseView& view) {
  const Table* found = find_table(view.results().derived, "precision_targets");
  if (!found) return "";
  const TableReader targets(*found);
  const std::vector<std::string> scene = scene_columns(view);
  std::vector<HtmlTable::Head> heads = {
      {"error"},     {"at most", true}, {"cheapest"},           {"with step"},      {"run time (s)", true},
      {"runner-up"}, {"with step"},     {"run time (s)", true}, {"speed-up", true}, {"spreads"}};
  if (!scene.empty()) heads.insert(heads.begin() + 1, {"scene"});
  HtmlTable table(
      "The cheapest method for a relative error of at most 10<sup>−k</sup>, 1 being a motion at rest: of the steps "
      "that were run, the one that takes the "
      "least time. Spread: fastest to slowest repeat (in the time's tooltip); where the spreads overlap, the two are "
      "not told apart.",
      std::move(heads));
  for (size_t row = 0; row < targets.size(); ++row) {
    Quantity quantity = error_quantity(targets.text(row, "error"));
    quantity.name = targets.text(row, "error");
    table.row().text(with_unit(quantity), "text");
    const CaseRecord* record = view.find(targets.text(row, "case"));
    if (!scene.empty()) table.text(record ? view.label(*record, scene) : "");
    const auto share = targets.number(row, targets.column_if_any("share"));
    table.number(power_text(share ? *share : targets.number(row, "at_most").value_or(0)),
                 share ? exact_text(targets.number(row, "at_most").value_or(0)) : "");
    case_cells(table, view, targets, row, "");
    case_cells(table, view, targets, row, "other_");
    if (const auto speed_up = targets.number(row, "speed_up"))
      table.number(number_text(*speed_up, 3) + " ×").text(targets.truth(row, "overlap") == true ? "overlap" : "apart");
    else
      table.absent().absent(false);
  }
  return table.size() == 0 ? "<p>No case has both an error and a run time.</p>\n" : table.html();
}

}  // namespace ricochet::report
