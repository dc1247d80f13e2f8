#include <fmt/format.h>

#include <algorithm>

#include "runners/kinds/comparison/page/page.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/html_table.hpp"

namespace ricochet::report {
namespace {

std::string interval_text(const AxisRows& rows, size_t row) {
  const auto low = rows.number(row, "low"), high = rows.number(row, "high");
  return low && high ? fmt::format("[{}, {}]", order_number(*low), order_number(*high)) : "";
}

/// The looks of a verdict: those of a status.
std::string verdict_class(const std::string& verdict) {
  return verdict == "refuted" ? "status failed" : verdict == "undecided" ? "status refused" : "status";
}

/// One order as "0.99 ✓": ✓ confirmed, ✕ refuted, ? undecided, none where nothing is declared.
void order_cell(HtmlTable& table, const AxisRows& rows, size_t row) {
  const std::string verdict = rows.text(row, "verdict"), interval = interval_text(rows, row);
  const auto order = rows.number(row, "order");
  const bool declared = rows.number(row, "declared").has_value();
  const std::string floor = rows.text(row, "saturates_at");
  if (!floor.empty()) {
    table.number(floor == "not told" ? "does not fall" : "floor: " + floor, verdict + ": " + rows.text(row, "reason"),
                 verdict_class(declared ? verdict : ""));
    return;
  }
  const char* mark = !declared ? "" : verdict == "confirmed" ? " ✓" : verdict == "refuted" ? " ✕" : " ?";
  table.number((order ? order_number(*order) : "–") + mark,
               fmt::format("{}{}{}: {}", interval, order ? " " : "", verdict, rows.text(row, "reason")),
               verdict_class(declared ? verdict : ""));
}

/// What a row is about, without the kind of error.
struct Method {
  std::string label, colour, key, refined;
  std::vector<size_t> rows;
};

std::vector<Method> methods(const CaseView& view, const AxisRows& rows) {
  std::vector<Method> out;
  for (size_t row = 0; row < rows.size(); ++row) {
    // What the row does not say (the element count of a refinement of elements) is not said.
    std::vector<std::string> columns;
    std::string key = rows.text(row, "refined");
    for (const std::string& column : rows.axes()) {
      if (!rows.text(row, column).empty()) columns.push_back(column);
      key += '\x1f' + rows.text(row, column);
    }
    auto found = std::find_if(out.begin(), out.end(), [&](const Method& m) { return m.key == key; });
    if (found == out.end()) {
      const CaseRecord* example = rows.example(row, view.results());
      found = out.insert(out.end(), {example ? view.name(*example, columns) : "the one method",
                                     example ? view.colour(*example) : "",
                                     key,
                                     rows.text(row, "refined"),
                                     {}});
    }
    found->rows.push_back(row);
  }
  return out;
}

/// The orders that a method declares over its errors: "1", "1, 2".
std::string declared_text(const AxisRows& rows, const Method& method) {
  std::vector<std::string> said;
  for (const size_t row : method.rows)
    if (const auto declared = rows.number(row, "declared")) {
      std::string text = number_text(*declared, 3);
      if (std::find(said.begin(), said.end(), text) == said.end()) said.push_back(std::move(text));
    }
  return said.empty() ? "–" : fmt::format("{}", fmt::join(said, ", "));
}

/// Methods × errors.
std::string matrix(const AxisRows& rows, const std::vector<Method>& all) {
  const std::vector<std::string> errors = rows.values("error");
  HtmlTable table(
      "Order p of e ≈ C r<sup>p</sup>, r the step or the length of an element, fitted over the range that behaves so. "
      "✓ confirms the declared order, ✕ refutes it, ? does not decide; the tooltip has the 95 % interval and the "
      "reason.",
      {{"method"}, {"refined"}, {"declared", true}});
  for (const std::string& error : errors) table.add({error, true});
  for (const Method& method : all) {
    table.row(method.label, method.colour).text(method.refined).number(declared_text(rows, method));
    for (const std::string& error : errors) {
      const auto found = std::find_if(method.rows.begin(), method.rows.end(),
                                      [&](size_t row) { return rows.text(row, "error") == error; });
      if (found == method.rows.end())
        table.absent();
      else
        order_cell(table, rows, *found);
    }
  }
  return table.html();
}

/// Every order with its interval and reason, what is not confirmed first.
std::string details(const AxisRows& rows, const std::vector<Method>& all) {
  HtmlTable table("",
                  {{"method"}, {"refined"}, {"error"}, {"order", true}, {"declared", true}, {"verdict"}, {"reason"}});
  for (const char* wanted : {"refuted", "undecided", "confirmed"})
    for (const Method& method : all)
      for (const size_t row : method.rows) {
        const std::string verdict = rows.text(row, "verdict");
        if (verdict != wanted) continue;
        const auto order = rows.number(row, "order"), declared = rows.number(row, "declared");
        table.row(method.label, method.colour).text(method.refined).text(rows.text(row, "error"), "text");
        const std::string floor = rows.text(row, "saturates_at");
        table.number(floor.empty() ? (order ? order_number(*order) : "–") + " " + interval_text(rows, row)
                                   : "floor: " + floor);
        table.number(declared ? number_text(*declared, 3) : "–");
        table.text(verdict, verdict_class(verdict)).text(rows.text(row, "reason"), "reason");
      }
  return "<details><summary>Every order with its interval, verdict and reason</summary>\n" + table.html() +
         "</details>\n";
}

/// "24 orders against what the methods declare: 18 confirmed, 2 refuted, 4 undecided."
std::string counts(const StudyResults& results) {
  const Table* verdicts = find_table(results.derived, "order_verdicts");
  if (!verdicts || verdicts->rows.empty()) return "";
  const TableReader rows(*verdicts);
  const auto count = [&](const char* column) { return static_cast<size_t>(rows.number(0, column).value_or(0)); };
  std::string out;
  for (const char* verdict : {"confirmed", "refuted", "undecided"})
    if (count(verdict) > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count(verdict), verdict);
  if (count("declared") == 0)
    return fmt::format("<p class=\"lead\">{}, none with a declared order to compare with.</p>\n",
                       count_text(count("orders"), "order", "orders"));
  return fmt::format("<p class=\"lead\">{} against what the methods declare: {}.</p>\n",
                     count_text(count("declared"), "order", "orders"), out);
}

}  // namespace

std::string orders_html(const CaseView& view) {
  const AxisRows rows(view.results(), "orders");
  if (rows.empty()) return "";
  const std::vector<Method> all = methods(view, rows);
  return counts(view.results()) + matrix(rows, all) + details(rows, all);
}

}  // namespace ricochet::report
