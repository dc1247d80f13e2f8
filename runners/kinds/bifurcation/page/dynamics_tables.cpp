#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_rows = 400;

std::string table_html(const std::string& caption, const std::vector<std::string>& headers,
                       const std::vector<std::string>& rows) {
  if (rows.empty()) return "";
  std::string out = fmt::format("<div class=\"scroll{}\"><table class=\"matrix\"><caption>{}</caption>\n<thead><tr>",
                                rows.size() > 24 ? " tall" : "", caption);
  for (const std::string& header : headers) out += "<th scope=\"col\">" + escape(header) + "</th>";
  out += "</tr></thead>\n<tbody>\n";
  for (size_t k = 0; k < std::min(rows.size(), most_rows); ++k) out += "<tr>" + rows[k] + "</tr>\n";
  out += "</tbody></table></div>\n";
  if (rows.size() > most_rows)
    out += fmt::format("<p class=\"fine\">{} more rows are in the table's CSV file.</p>\n", rows.size() - most_rows);
  return out;
}

std::string number_cell(std::optional<double> value, int digits = 6) {
  return value
             ? fmt::format("<td class=\"number\" title=\"{}\">{}</td>", exact_text(*value), number_text(*value, digits))
             : "<td class=\"number absent\">–</td>";
}

std::string text_cell(const std::string& text) {
  return "<td>" + (text.empty() ? "–" : escape(text)) + "</td>";
}

std::string interval_text(const AxisRows& rows, size_t row, const char* low, const char* high, int digits = 7) {
  const auto a = rows.number(row, low), b = rows.number(row, high);
  return a && b ? number_text(*a, digits) + " to " + number_text(*b, digits) : "";
}

/// What a case is called, by its id.
class Names {
 public:
  explicit Names(const CaseView& view) {
    for (const CaseRecord* record : view.all()) {
      const std::string label = view.label(*record);
      names_[record->id] = label.empty() ? "the one method" : label;
    }
  }
  std::string of(const std::string& id) const {
    const auto found = names_.find(id);
    return found == names_.end() ? id : found->second;
  }

 private:
  std::map<std::string, std::string> names_;
};

std::string percent_range(const AxisRows& rows, size_t row) {
  const auto value = rows.number(row, "fraction");
  if (!value) return "";
  std::string out = share_text(*value);
  const auto low = rows.number(row, "fraction_low"), high = rows.number(row, "fraction_high");
  if (low && high) out += fmt::format(" ({} to {})", share_text(*low), share_text(*high));
  return out;
}

std::string attractors_html(const StudyResults& results) {
  const AxisRows rows(results, "attractors");
  std::vector<std::string> html;
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto period = rows.number(row, "period");
    const std::string regime = rows.text(row, "class");
    const size_t group = regime_group(regime, period ? std::optional(static_cast<int>(*period)) : std::nullopt);
    const std::string what = regime_text(regime, period);
    const std::string symmetric = rows.text(row, "symmetric").empty() ? "" : rows.flag(row, "symmetric") ? "yes" : "no";
    html.push_back(
        fmt::format("<th scope=\"row\">{}</th><td><span class=\"swatch\" style=\"background:{}\"></span>{}</td>",
                    escape(rows.text(row, "attractor")), regime_groups[group].colour, escape(what)) +
        text_cell(symmetric) + text_cell(rows.text(row, "label")) + number_cell(rows.number(row, "cases")) +
        text_cell(interval_text(rows, row, "from", "to", 6)) + text_cell(percent_range(rows, row)) +
        "<td class=\"reason\">" +
        escape(rows.text(row, "sentence").empty() ? rows.text(row, "presence") : rows.text(row, "sentence")) + "</td>");
  }
  const std::string table = table_html(
      "One identity along the parameter and over all methods. Fraction: of the starts that lead there where it exists, "
      "with its 95 % interval. Orbits that are each other's image under x → −x, t → t + T/2 count as one.",
      {"attractor", "class", "symmetric", "label", "cases", "from, to", "fraction of starts", "where"}, html);
  return table.empty() ? "" : "<h3>Attractors</h3>\n" + table;
}

std::string shifts_html(const StudyResults& results, const Names& names, const Quantity& parameter) {
  const AxisRows rows(results, "shifts");
  std::vector<std::string> html;
  std::string reference;
  for (size_t row = 0; row < rows.size(); ++row) {
    reference = rows.text(row, "reference_case");
    std::string shift = "<td class=\"number\">–</td>", interval = "–";
    if (const auto value = rows.number(row, "shift")) {
      const auto low = rows.number(row, "low"), high = rows.number(row, "high");
      const bool beyond = low && high && (*low > 0 || *high < 0);
      shift = fmt::format("<td class=\"number{}\" title=\"{}\">{}</td>", beyond ? " kept" : "", exact_text(*value),
                          number_text(*value, 3));
      if (low && high) interval = number_text(*low, 3) + " to " + number_text(*high, 3);
    }
    html.push_back("<th scope=\"row\">" + escape(names.of(rows.text(row, "case"))) + "</th>" +
                   text_cell(rows.text(row, "start")) +
                   text_cell(rows.text(row, "from") + " → " + rows.text(row, "to")) +
                   text_cell(rows.text(row, "kind")) + number_cell(rows.number(row, "reference_value"), 7) +
                   number_cell(rows.number(row, "value"), 7) + shift + "<td class=\"number\">" + interval + "</td>" +
                   text_cell(rows.number(row, "value")         ? ""
                             : rows.text(row, "found").empty() ? ""
                                                               : "not found"));
  }
  const std::string table = table_html(
      fmt::format("Where the changes of the reference ({}) lie in the other methods, in {}. Bold: the interval of the "
                  "shift leaves out zero.",
                  escape(names.of(reference)), escape(with_unit(parameter))),
      {"method", "start", "change", "kind", "reference", "here", "shift", "interval", ""}, html);
  return table.empty() ? "" : "<h3>Shifts of the changes</h3>\n" + table;
}

std::string changes_html(const CaseView& view, const Names& names, const Quantity& parameter) {
  std::vector<std::string> html;
  for (const CaseRecord* record : view.all()) {
    const Table* table = find_table(record->tables, "bifurcations");
    if (!table) continue;
    const TableReader rows(*table);
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto low = rows.number(row, "low"), high = rows.number(row, "high");
      html.push_back("<th scope=\"row\">" + escape(names.of(record->id)) + "</th>" +
                     text_cell(rows.text(row, "start")) + text_cell(rows.text(row, "kind")) +
                     text_cell(rows.text(row, "from") + " → " + rows.text(row, "to")) +
                     number_cell(rows.number(row, "value"), 9) +
                     (low && high ? number_cell(*high - *low, 2) : number_cell(std::nullopt)));
    }
  }
  const std::string table =
      table_html(fmt::format("Where regimes change, as {}; width: of the interval that holds the change.",
                             escape(with_unit(parameter))),
                 {"method", "start", "kind", "change", "value", "width"}, html);
  return table.empty() ? "" : "<h3>Located changes</h3>\n" + table;
}

/// White to blue; the text turns white where the ground is dark.
std::string heat_style(double share) {
  const auto mix = [&](int full) { return static_cast<int>(std::lround(255 + share * (full - 255))); };
  return fmt::format("background:#{:02X}{:02X}{:02X};color:{}", mix(0x00), mix(0x60), mix(0xA0),
                     share > 0.6 ? "#fff" : "#222");
}

std::string agreement_html(const StudyResults& results, const Names& names) {
  const AxisRows rows(results, "agreement");
  if (rows.empty()) return "";
  const std::vector<std::string> cases = rows.values("case"), others = rows.values("other_case");
  std::map<std::pair<std::string, std::string>, size_t> place;
  for (size_t row = 0; row < rows.size(); ++row) place[{rows.text(row, "case"), rows.text(row, "other_case")}] = row;
  std::string head, body;
  for (size_t k = 0; k < others.size(); ++k)
    head += fmt::format("<th scope=\"col\" class=\"number\" title=\"{}\">{}</th>", escape(names.of(others[k])), k + 1);
  size_t number = 0;
  for (const std::string& one : cases) {
    const auto at = std::find(others.begin(), others.end(), one);
    number = static_cast<size_t>(at - others.begin()) + 1;
    body += fmt::format("<tr><th scope=\"row\">{} {}</th>", number, escape(names.of(one)));
    for (const std::string& other : others) {
      const auto found = place.find({one, other});
      const auto share = found == place.end() ? std::nullopt : rows.number(found->second, "share");
      if (!share) {
        body += "<td class=\"number absent\">–</td>";
        continue;
      }
      const double compared = rows.number(found->second, "compared").value_or(0);
      const auto attractors = rows.number(found->second, "share_attractor");
      body += fmt::format(
          "<td class=\"number\" style=\"{}\" title=\"{} and {}: the same class in {} of {} values and "
          "starts{}\">{:.0f}</td>",
          heat_style(std::clamp(*share, 0.0, 1.0)), escape(names.of(one)), escape(names.of(other)),
          number_text(rows.number(found->second, "same_class").value_or(std::round(*share * compared))),
          number_text(compared), attractors ? ", the same attractor in " + share_text(*attractors) : "", 100 * *share);
    }
    body += "</tr>\n";
  }
  return fmt::format(
      "<h3>Agreement of methods</h3>\n<div class=\"scroll\"><table class=\"matrix heat\"><caption>Values and starts at "
      "which two methods find the same class, in per cent of those that both decide.</caption>\n<thead><tr><th "
      "scope=\"col\">method</th>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      head, body);
}

}  // namespace

std::string dynamics_tables_html(const CaseView& view) {
  const Names names(view);
  const Quantity parameter = swept_parameter(view.results());
  return attractors_html(view.results()) + agreement_html(view.results(), names) +
         shifts_html(view.results(), names, parameter) + changes_html(view, names, parameter);
}

}  // namespace ricochet::report
