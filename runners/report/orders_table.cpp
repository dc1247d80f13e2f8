#include <fmt/format.h>

#include <algorithm>

#include "runners/report/evidence.hpp"
#include "runners/report/evidence_rows.hpp"
#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

std::string number_cell(std::optional<double> value) {
  return value ? fmt::format("<td class=\"number\" title=\"{}\">{}</td>", exact_text(*value), number_text(*value, 3))
               : "<td class=\"number absent\">–</td>";
}

std::string order_cell(const EvidenceRows& rows, size_t row) {
  const auto order = rows.number(row, "order"), low = rows.number(row, "low"), high = rows.number(row, "high");
  if (!order) return "<td class=\"number absent\">–</td>";
  std::string interval;
  if (low && high) interval = fmt::format(" [{}, {}]", number_text(*low, 3), number_text(*high, 3));
  return fmt::format("<td class=\"number\" title=\"{}\">{}{}</td>", exact_text(*order), number_text(*order, 3),
                     interval);
}

/// The looks of a verdict: those of a status.
std::string verdict_class(const std::string& verdict) {
  return verdict == "refuted" ? "status failed" : verdict == "undecided" ? "status refused" : "status";
}

/// "24 orders against what the methods declare: 18 confirmed, 2 refuted, 4 undecided."
std::string counts(const EvidenceRows& rows) {
  std::string out;
  size_t declared = 0;
  for (const char* verdict : {"confirmed", "refuted", "undecided"}) {
    size_t count = 0;
    for (size_t row = 0; row < rows.size(); ++row)
      count += rows.number(row, "declared") && rows.text(row, "verdict") == verdict;
    declared += count;
    if (count) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, verdict);
  }
  if (declared == 0)
    return fmt::format("<p class=\"lead\">{}, none with a declared order to compare with.</p>\n",
                       count_text(rows.size(), "order", "orders"));
  return fmt::format("<p class=\"lead\">{} against what the methods declare: {}.</p>\n",
                     count_text(declared, "order", "orders"), out);
}

}  // namespace

std::string orders_html(const CaseView& view) {
  const EvidenceRows rows(view.results(), "orders");
  if (rows.empty()) return "";
  std::string body;
  for (size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* example = rows.example(row, view.results());
    // What the row does not say (the element count of a refinement of elements) is not said.
    std::vector<std::string> columns;
    for (const std::string& column : rows.axes())
      if (!rows.text(row, column).empty()) columns.push_back(column);
    const std::string label = example ? view.label(*example, columns) : "";
    const std::string swatch =
        example ? fmt::format("<span class=\"swatch\" style=\"background:{}\"></span>", view.colour(*example)) : "";
    const std::string verdict = rows.text(row, "verdict");
    body += fmt::format(
        "<tr><th scope=\"row\">{}{}</th><td>{}</td><td>{}</td>{}{}<td class=\"{}\">{}</td><td "
        "class=\"reason\">{}</td></tr>\n",
        swatch, escape(label.empty() ? "the one method" : label), escape(rows.text(row, "refined")),
        escape(rows.text(row, "error")), order_cell(rows, row), number_cell(rows.number(row, "declared")),
        verdict_class(verdict), escape(verdict), escape(rows.text(row, "reason")));
  }
  return counts(rows) +
         fmt::format(
             "<div class=\"scroll{}\"><table class=\"matrix\"><caption>Order p of e ≈ C r<sup>p</sup>, r the step or "
             "the "
             "length of an element, fitted over the range that behaves so, with its 95 % interval.</caption>\n"
             "<thead><tr><th scope=\"col\">method</th><th scope=\"col\">refined</th><th scope=\"col\">error</th><th "
             "scope=\"col\" class=\"number\">order</th><th scope=\"col\" class=\"number\">declared</th><th "
             "scope=\"col\">verdict</th><th "
             "scope=\"col\">reason</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
             rows.size() > 24 ? " tall" : "", body);
}

}  // namespace ricochet::report
