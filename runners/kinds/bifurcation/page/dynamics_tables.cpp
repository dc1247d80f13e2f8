#include "runners/kinds/bifurcation/page/dynamics_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
namespace {

std::string value_text(double value, const Quantity& parameter) {
  return number_text(value, 7) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

/// Orbits by group of classes.
using GroupCounts = std::array<size_t, regime_groups.size()>;

/// Those of each case, from `class_counts`.
std::map<std::string, GroupCounts> count_groups(const StudyResults& results) {
  std::map<std::string, GroupCounts> out;
  const Table* counts = find_table(results.derived, "class_counts");
  if (!counts) return out;
  const TableReader rows(*counts);
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto period = rows.number(row, "period");
    const size_t group =
        regime_group(rows.text(row, "class"), period ? std::optional(static_cast<int>(*period)) : std::nullopt);
    out[rows.text(row, "case")][group] += static_cast<size_t>(rows.number(row, "orbits").value_or(0));
  }
  return out;
}

GroupCounts total_of(const std::map<std::string, GroupCounts>& counts) {
  GroupCounts out{};
  for (const auto& [id, own] : counts)
    for (size_t group = 0; group < own.size(); ++group) out[group] += own[group];
  return out;
}

std::string regime_sentence(const GroupCounts& counts) {
  const size_t all = std::accumulate(counts.begin(), counts.end(), size_t{0});
  std::string parts;
  for (size_t group = 0; group < counts.size(); ++group)
    if (counts[group] > 0)
      parts += fmt::format("{}{}{}: {}", parts.empty() ? "" : ", ", swatch(regime_groups[group].colour),
                           regime_groups[group].name, counts[group]);
  return fmt::format("<p>Regimes of {}: {}.</p>\n", count_text(all, "orbit", "orbits"), parts);
}

/// Where motion first touches, over the methods, for each start.
std::string grazing_sentence(const StudyResults& results, const Cases& cases, const Quantity& parameter) {
  const Table* ranges = find_table(results.derived, "grazing_ranges");
  if (!ranges) return "";
  const TableReader rows(*ranges);
  std::string out;
  for (const std::string& start : starts_in(cases))
    for (size_t row = 0; row < rows.size(); ++row) {
      if (rows.text(row, "start") != start) continue;
      const double low = rows.number(row, "low").value_or(0), high = rows.number(row, "high").value_or(0);
      const std::string text =
          low == high ? value_text(low, parameter) : number_text(low, 7) + " to " + value_text(high, parameter);
      out += fmt::format("<p>Grazing, start {}: {} ({}; each located to {}).</p>\n", escape(start), text,
                         count_text(static_cast<size_t>(rows.number(row, "changes").value_or(0)), "change", "changes"),
                         value_text(rows.number(row, "bracket").value_or(0), parameter));
    }
  return out;
}

/// A row of `numerical_viscosity`.
struct Viscosity {
  Interval numerical = Interval::nothing(), physical = Interval::nothing();
  std::optional<double> share;  ///< largest |α_eq|/α
  bool small = true;
};

std::map<std::string, Viscosity> viscosities_of(const StudyResults& results) {
  std::map<std::string, Viscosity> out;
  const Table* table = find_table(results.derived, "numerical_viscosity");
  if (!table) return out;
  const TableReader rows(*table);
  for (size_t row = 0; row < rows.size(); ++row) {
    Viscosity& one = out[rows.text(row, "case")];
    for (const char* end : {"low", "high"})
      if (const auto value = rows.number(row, end)) one.numerical.include(*value);
    for (const char* end : {"physical_low", "physical_high"})
      if (const auto value = rows.number(row, end)) one.physical.include(*value);
    one.share = rows.number(row, "share");
    one.small = rows.truth(row, "small").value_or(true);
  }
  return out;
}

std::string range_text(const Interval& range) {
  const std::string low = number_text(range.low, 3), high = number_text(range.high, 3);
  return low == high ? low : low + " to " + high;
}

/// α_eq with its share of α; below 1e-12 of it, nothing is told from round-off.
void viscosity_cell(HtmlTable& table, const Viscosity* v) {
  if (!v) {
    table.absent(false);
    return;
  }
  const std::string range = range_text(v->numerical);
  const bool feeds = v->numerical.low < 0 && -v->numerical.low >= v->numerical.high;
  if (v->numerical.low == 0 && v->numerical.high == 0)
    table.text("0", "text");
  else if (!v->share)
    table.text(range + ": no α to compare with", "warned");
  else if (*v->share < 1e-12)
    table.text("0 to round-off", "text");
  else if (v->small)
    table.text(range + ": " + share_text(*v->share) + " of α", "text");
  else
    table.text("▲ " + range + ": " + share_text(*v->share) + " of α" + (feeds ? ", feeding energy" : ""), "warned");
}

/// What the viscosities of the methods are told against.
std::string viscosity_caption(const std::map<std::string, Viscosity>& viscosities) {
  if (viscosities.empty()) return "";
  Interval physical = Interval::nothing();
  size_t not_small = 0;
  for (const auto& [id, v] : viscosities) {
    physical.include(v.physical);
    not_small += !v.small;
  }
  return fmt::format(
      " α_eq: the stiffness viscosity (s) that the scheme adds to α = {} of the scene, fitted on the free decay of the "
      "first modes. ▲: more than 1 % of α, so not ≪ α: {} of {} methods.",
      physical.empty() ? "0" : range_text(physical) + " s", not_small, viscosities.size());
}

/// Methods × regimes, with the viscosity of each method.
std::string regime_table(const CaseView& view, const Cases& cases, const std::map<std::string, GroupCounts>& by_case) {
  const GroupCounts all = total_of(by_case);
  const std::map<std::string, Viscosity> viscosities = viscosities_of(view.results());
  HtmlTable table("Orbits (values × starts) by regime." + viscosity_caption(viscosities), {{"method"}});
  for (size_t group = 0; group < all.size(); ++group)
    if (all[group] > 0) table.add({regime_groups[group].name, true, "", regime_groups[group].colour});
  if (!viscosities.empty()) table.add({"α_eq"});
  for (const CaseRecord* record : cases) {
    const GroupCounts& counts = by_case.at(record->id);
    const size_t total = std::accumulate(counts.begin(), counts.end(), size_t{0});
    table.row(view.name(*record), "", record->partial ? " <em>(partial)</em>" : "");
    for (size_t group = 0; group < all.size(); ++group) {
      if (all[group] == 0) continue;
      if (counts[group] == 0)
        table.absent();
      else
        table.number(std::to_string(counts[group]),
                     share_text(static_cast<double>(counts[group]) / static_cast<double>(total)));
    }
    const auto viscosity = viscosities.find(record->id);
    if (!viscosities.empty()) viscosity_cell(table, viscosity == viscosities.end() ? nullptr : &viscosity->second);
  }
  return table.html();
}

}  // namespace

std::string dynamics_answer_html(const CaseView& view) {
  const std::map<std::string, GroupCounts> counts = count_groups(view.results());
  Cases cases;
  for (const CaseRecord* record : view.all())
    if (counts.contains(record->id)) cases.push_back(record);
  if (cases.empty()) return "";
  const Quantity parameter = swept_parameter(view.results());
  return regime_sentence(total_of(counts)) + grazing_sentence(view.results(), cases, parameter) +
         regime_table(view, cases, counts);
}

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
