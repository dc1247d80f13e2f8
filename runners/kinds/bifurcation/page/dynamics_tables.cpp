#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/axis_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/html_table.hpp"

namespace ricochet::report {
namespace {

std::string interval_text(const AxisRows& rows, size_t row, const char* low, const char* high, int digits = 7) {
  const auto a = rows.number(row, low), b = rows.number(row, high);
  return a && b ? number_text(*a, digits) + " to " + number_text(*b, digits) : "";
}

/// The table under its title; "" without rows.
std::string titled(const char* title, const HtmlTable& table) {
  return table.size() == 0 ? "" : fmt::format("<h3>{}</h3>\n", title) + table.html();
}

std::string attractors_html(const StudyResults& results) {
  const AxisRows rows(results, "attractors");
  HtmlTable table(
      "One identity along the parameter and over all methods. Fraction: of the starts that lead there where it exists, "
      "with its 95 % interval. Orbits that are each other's image under x → −x, t → t + T/2 count as one.",
      {{"attractor"}, {"class"}, {"symmetric"}, {"label"}, {"cases"}, {"from, to"}, {"fraction of starts"}, {"where"}});
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto period = rows.number(row, "period"), share = rows.number(row, "fraction");
    const std::string regime = rows.text(row, "class"), sentence = rows.text(row, "sentence");
    const size_t group = regime_group(regime, period ? std::optional(static_cast<int>(*period)) : std::nullopt);
    const std::string symmetric = rows.text(row, "symmetric").empty() ? "" : rows.flag(row, "symmetric") ? "yes" : "no";
    table.row(rows.text(row, "attractor"));
    table.cell(swatch(regime_groups[group].colour) + escape(regime_text(regime, period)));
    table.text(symmetric).text(rows.text(row, "label")).number(rows.number(row, "cases"));
    table.text(interval_text(rows, row, "from", "to", 6))
        .text(share ? share_text(*share, rows.number(row, "fraction_low"), rows.number(row, "fraction_high")) : "");
    table.text(sentence.empty() ? rows.text(row, "presence") : sentence, "reason");
  }
  return titled("Attractors", table);
}

std::string shifts_html(const CaseView& view, const Quantity& parameter) {
  const AxisRows rows(view.results(), "shifts");
  if (rows.empty()) return "";
  HtmlTable table(
      fmt::format("Where the changes of the reference ({}) lie in the other methods, in {}. Bold: the interval of the "
                  "shift leaves out zero.",
                  escape(view.name_of(rows.text(rows.size() - 1, "reference_case"))), escape(with_unit(parameter))),
      {{"method"}, {"start"}, {"change"}, {"kind"}, {"reference"}, {"here"}, {"shift"}, {"interval"}, {""}});
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto here = rows.number(row, "value"), shift = rows.number(row, "shift"), low = rows.number(row, "low"),
               high = rows.number(row, "high");
    const bool beyond = low && high && (*low > 0 || *high < 0), known = shift && low && high;
    table.row(view.name_of(rows.text(row, "case"))).text(rows.text(row, "start"));
    table.text(rows.text(row, "from") + " → " + rows.text(row, "to")).text(rows.text(row, "kind"));
    table.number(rows.number(row, "reference_value"), 7).number(here, 7);
    if (shift)
      table.number(number_text(*shift, 3), exact_text(*shift), beyond ? "kept" : "");
    else
      table.number("–");
    table.number(known ? number_text(*low, 3) + " to " + number_text(*high, 3) : "–");
    table.text(here || rows.text(row, "found").empty() ? "" : "not found");
  }
  return titled("Shifts of the changes", table);
}

std::string changes_html(const CaseView& view, const Quantity& parameter) {
  HtmlTable table(fmt::format("Where regimes change, as {}; width: of the interval that holds the change.",
                              escape(with_unit(parameter))),
                  {{"method"}, {"start"}, {"kind"}, {"change"}, {"value"}, {"width"}});
  for (const CaseRecord* record : view.all()) {
    const Table* own = find_table(record->tables, "bifurcations");
    if (!own) continue;
    const TableReader rows(*own);
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto low = rows.number(row, "low"), high = rows.number(row, "high");
      table.row(view.name(*record)).text(rows.text(row, "start")).text(rows.text(row, "kind"));
      table.text(rows.text(row, "from") + " → " + rows.text(row, "to")).number(rows.number(row, "value"), 9);
      table.number(low && high ? std::optional(*high - *low) : std::nullopt, 2);
    }
  }
  return titled("Located changes", table);
}

/// White to blue; the text turns white where that stands out more, never below a contrast of 4.5.
std::string heat_style(double share) {
  const auto mix = [&](int full) { return static_cast<int>(std::lround(255 + share * (full - 255))); };
  return fmt::format("background:#{:02X}{:02X}{:02X};color:{}", mix(0x00), mix(0x60), mix(0xA0),
                     share > 0.83 ? "#fff" : "#000");
}

std::string agreement_html(const CaseView& view) {
  const AxisRows rows(view.results(), "agreement");
  if (rows.empty()) return "";
  const std::vector<std::string> cases = rows.values("case"), others = rows.values("other_case");
  std::map<std::pair<std::string, std::string>, size_t> place;
  for (size_t row = 0; row < rows.size(); ++row) place[{rows.text(row, "case"), rows.text(row, "other_case")}] = row;
  HtmlTable table("Values and starts at which two methods find the same class, in per cent of those that both decide.",
                  {{"method"}}, "matrix heat");
  for (size_t k = 0; k < others.size(); ++k) table.add({std::to_string(k + 1), true, view.name_of(others[k])});
  for (const std::string& one : cases) {
    const auto number = std::find(others.begin(), others.end(), one) - others.begin() + 1;
    table.row(fmt::format("{} {}", number, view.name_of(one)));
    for (const std::string& other : others) {
      const auto found = place.find({one, other});
      const auto share = found == place.end() ? std::nullopt : rows.number(found->second, "share");
      if (!share) {
        table.absent();
        continue;
      }
      const double compared = rows.number(found->second, "compared").value_or(0);
      const auto attractors = rows.number(found->second, "share_attractor");
      table.cell(
          fmt::format("{:.0f}", 100 * *share),
          fmt::format(
              " class=\"number\" style=\"{}\" title=\"{} and {}: the same class in {} of {} values and starts{}\"",
              heat_style(std::clamp(*share, 0.0, 1.0)), escape(view.name_of(one)), escape(view.name_of(other)),
              number_text(rows.number(found->second, "same_class").value_or(std::round(*share * compared))),
              number_text(compared), attractors ? ", the same attractor in " + share_text(*attractors) : ""));
    }
  }
  return titled("Agreement of methods", table);
}

}  // namespace

std::string dynamics_tables_html(const CaseView& view) {
  const Quantity parameter = swept_parameter(view.results());
  return attractors_html(view.results()) + agreement_html(view) + shifts_html(view, parameter) +
         changes_html(view, parameter);
}

}  // namespace ricochet::report
