#include <fmt/format.h>

#include <algorithm>

#include "runners/kinds/work-precision/page/page.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

std::string case_cells(const CaseView& view, const TableReader& targets, size_t row, const std::string& prefix) {
  const auto column = [&](const char* name) { return prefix + name; };
  const CaseRecord* record = view.find(targets.text(row, column("case")));
  if (!record) return "<td class=\"absent\">no other</td><td class=\"absent\">–</td><td class=\"number absent\">–</td>";
  std::vector<std::string> methods;
  for (const std::string& axis : view.varying())
    if (role_of(axis) == "mass" || role_of(axis) == "contact" || role_of(axis) == "time") methods.push_back(axis);
  const std::string label = view.label(*record, methods);
  std::string how = exact_text(CaseView::number(*record, "step").value_or(0)) + " s";
  if (view.varies("elements")) how += ", " + CaseView::text(*record, "elements") + " elements";
  const auto seconds = [&](const char* name, int digits) {
    return number_text(targets.number(row, column(name)).value_or(0), digits);
  };
  return fmt::format("<td>{}</td><td>{}</td><td class=\"number\" title=\"{} to {} s\">{}</td>",
                     escape(label.empty() ? "the one method" : label), escape(how), seconds("low", 4),
                     seconds("high", 4), seconds("seconds", 3));
}

std::string target_row(const CaseView& view, const TableReader& targets, size_t row, const std::string& head) {
  const auto speed_up = targets.number(row, "speed_up");
  return fmt::format("<tr>{}<td class=\"number\">{}</td>{}{}{}</tr>\n", head,
                     power_text(targets.number(row, "at_most").value_or(0)), case_cells(view, targets, row, ""),
                     case_cells(view, targets, row, "other_"),
                     speed_up ? fmt::format("<td class=\"number\">{} ×</td><td>{}</td>", number_text(*speed_up, 3),
                                            targets.truth(row, "overlap") == true ? "overlap" : "apart")
                              : "<td class=\"number absent\">–</td><td class=\"absent\">–</td>");
}

}  // namespace

std::string work_precision_html(const CaseView& view) {
  const Table* table = find_table(view.results().derived, "precision_targets");
  if (!table) return "";
  const TableReader targets(*table);
  const std::vector<std::string> scene = view.varying_without({"mass", "contact", "time", "elements", "step"});
  std::string rows;
  for (size_t row = 0; row < targets.size(); ++row) {
    const std::string error = targets.text(row, "error");
    Quantity quantity = error_quantity(error);
    quantity.name = error;
    std::string head = fmt::format("<td class=\"text\">{}</td>", escape(with_unit(quantity)));
    const CaseRecord* record = view.find(targets.text(row, "case"));
    if (!scene.empty()) head += fmt::format("<td>{}</td>", record ? escape(view.label(*record, scene)) : "");
    rows += target_row(view, targets, row, head);
  }
  if (rows.empty()) return "<p>No case has both an error and a run time.</p>\n";
  return fmt::format(
      "<div class=\"scroll{}\"><table class=\"matrix\"><caption>The cheapest method for an error of at most 10<sup>−k"
      "</sup>: of the steps that were run, the one that takes the least time. Spread: fastest to slowest repeat (in "
      "the time's tooltip); where the spreads overlap, the two are not told apart.</caption>\n<thead><tr><th "
      "scope=\"col\">error</th>{}<th scope=\"col\" class=\"number\">at "
      "most</th><th scope=\"col\">cheapest</th><th scope=\"col\">with step</th><th scope=\"col\" class=\"number\">run "
      "time "
      "(s)</th><th scope=\"col\">runner-up</th><th scope=\"col\">with step</th><th scope=\"col\" class=\"number\">run "
      "time (s)</th><th scope=\"col\" class=\"number\">speed-up</th><th "
      "scope=\"col\">spreads</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      std::count(rows.begin(), rows.end(), '\n') > 24 ? " tall" : "",
      scene.empty() ? "" : "<th scope=\"col\">scene</th>", rows);
}

}  // namespace ricochet::report
