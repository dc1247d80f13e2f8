#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "runners/kinds/bifurcation/page/page.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"

namespace ricochet::report {
namespace {

/// What some numbers reach; empty until a finite one is included.
struct Interval {
  double low = 0, high = 0;
  bool empty() const { return !(low <= high); }
  static Interval nothing() { return {1, -1}; }
  void include(double value) {
    if (!std::isfinite(value)) return;
    if (empty()) low = high = value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void include(const Interval& other) {
    if (other.empty()) return;
    include(other.low);
    include(other.high);
  }
};

std::string value_text(double value, const Quantity& parameter) {
  return number_text(value, 7) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

/// Orbits by group of classes.
using GroupCounts = std::array<size_t, regime_groups.size()>;

/// Those of each case, from `class_counts`.
std::map<std::string, GroupCounts> count_groups(const StudyResults& results) {
  std::map<std::string, GroupCounts> out;
  for (const ClassCount& row : class_counts_type().read(results.derived))
    out[row.id][regime_group(row.regime, row.period)] += static_cast<size_t>(row.orbits);
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
  const std::vector<GrazingRange> rows = grazing_ranges_type().read(results.derived);
  std::string out;
  for (const std::string& start : starts_in(cases))
    for (const GrazingRange& row : rows) {
      if (row.start != start) continue;
      const double low = row.low.value_or(0), high = row.high.value_or(0);
      const std::string text =
          low == high ? value_text(low, parameter) : number_text(low, 7) + " to " + value_text(high, parameter);
      out += fmt::format("<p>Grazing, start {}: {} ({}; each located to {}).</p>\n", escape(start), text,
                         count_text(static_cast<size_t>(row.changes), "change", "changes"),
                         value_text(row.bracket, parameter));
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
  for (const NumericalViscosity& row : numerical_viscosity_type().read(results.derived)) {
    Viscosity& one = out[row.id];
    for (const auto& value : {row.low, row.high})
      if (value) one.numerical.include(*value);
    for (const auto& value : {row.physical_low, row.physical_high})
      if (value) one.physical.include(*value);
    one.share = row.share;
    one.small = row.small.value_or(true);
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
  // Without α it is told in the unit of time: of a second that is round-off.
  constexpr double round_off = 1e-15;
  if (v->numerical.low == 0 && v->numerical.high == 0)
    table.text("0", "text");
  else if (!v->share && std::max(std::abs(v->numerical.low), std::abs(v->numerical.high)) < round_off)
    table.text("0 to round-off", "text");
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
std::string regime_table(const Choices& choices, const Cases& cases,
                         const std::map<std::string, GroupCounts>& by_case) {
  const GroupCounts all = total_of(by_case);
  const std::map<std::string, Viscosity> viscosities = viscosities_of(choices.results());
  HtmlTable table("Orbits (values × starts) by regime." + viscosity_caption(viscosities), {{"method"}});
  for (size_t group = 0; group < all.size(); ++group)
    if (all[group] > 0) table.add({regime_groups[group].name, true, "", regime_groups[group].colour});
  if (!viscosities.empty()) table.add({"α_eq"});
  for (const CaseRecord* record : cases) {
    const GroupCounts& counts = by_case.at(record->id);
    const size_t total = std::accumulate(counts.begin(), counts.end(), size_t{0});
    table.row(choices.short_name(*record), "", record->partial ? " <em>(partial)</em>" : "");
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

std::string dynamics_answer_html(const Choices& choices) {
  const std::map<std::string, GroupCounts> counts = count_groups(choices.results());
  Cases cases;
  for (const CaseRecord* record : all_cases(choices.results()))
    if (counts.contains(record->id)) cases.push_back(record);
  if (cases.empty()) return "";
  const Quantity parameter = swept_parameter(choices.results());
  return regime_sentence(total_of(counts)) + grazing_sentence(choices.results(), cases, parameter) +
         regime_table(choices, cases, counts);
}

namespace {

std::string interval_text(const std::optional<double>& low, const std::optional<double>& high, int digits = 7) {
  return low && high ? number_text(*low, digits) + " to " + number_text(*high, digits) : "";
}

std::vector<std::string> distinct(const std::vector<AgreementRow>& rows, std::string AgreementRow::*member) {
  std::vector<std::string> out;
  for (const AgreementRow& row : rows)
    if (std::find(out.begin(), out.end(), row.*member) == out.end()) out.push_back(row.*member);
  return out;
}

/// The table under its title; "" without rows.
std::string titled(const char* title, const HtmlTable& table) {
  return table.size() == 0 ? "" : fmt::format("<h3>{}</h3>\n", title) + table.html();
}

std::string attractors_html(const StudyResults& results) {
  HtmlTable table(
      "One identity along the parameter and over all methods. Fraction: of the starts that lead there where it exists, "
      "with its 95 % interval. Orbits that are each other's image under x → −x, t → t + T/2 count as one.",
      {{"attractor"}, {"class"}, {"symmetric"}, {"label"}, {"cases"}, {"from, to"}, {"fraction of starts"}, {"where"}});
  for (const AttractorRow& row : attractors_type().read(results.derived)) {
    const size_t group = regime_group(row.regime, row.period);
    table.row(row.attractor ? std::to_string(*row.attractor) : "");
    table.cell(swatch(regime_groups[group].colour) + escape(regime_text(row.regime, row.period)));
    table.text(!row.symmetric ? "" : *row.symmetric ? "yes" : "no").text(row.label).number(row.cases);
    table.text(interval_text(row.from, row.to, 6))
        .text(row.fraction ? share_text(*row.fraction, row.fraction_low, row.fraction_high) : "");
    table.text(row.sentence.empty() ? row.presence : row.sentence, "reason");
  }
  return titled("Attractors", table);
}

std::string shifts_html(const Choices& choices, const Quantity& parameter) {
  const std::vector<ShiftRow> rows = shifts_type().read(choices.results().derived);
  if (rows.empty()) return "";
  HtmlTable table(
      fmt::format("Where the changes of the reference ({}) lie in the other methods, in {}. Bold: the interval of the "
                  "shift leaves out zero.",
                  escape(choices.name_of(rows.back().reference)), escape(with_unit(parameter))),
      {{"method"}, {"start"}, {"change"}, {"kind"}, {"reference"}, {"here"}, {"shift"}, {"interval"}, {""}});
  for (const ShiftRow& row : rows) {
    const bool beyond = row.low && row.high && (*row.low > 0 || *row.high < 0);
    table.row(choices.name_of(row.id)).text(row.start).text(row.from + " → " + row.to).text(row.kind);
    table.number(row.reference_value, 7).number(row.value, 7);
    if (row.shift)
      table.number(number_text(*row.shift, 3), exact_text(*row.shift), beyond ? "kept" : "");
    else
      table.number("–");
    const std::string interval = row.shift ? interval_text(row.low, row.high, 3) : "";
    table.number(interval.empty() ? "–" : interval);
    table.text(row.value || !row.found ? "" : "not found");
  }
  return titled("Shifts of the changes", table);
}

std::string changes_html(const Choices& choices, const Quantity& parameter) {
  HtmlTable table(fmt::format("Where regimes change, as {}; width: of the interval that holds the change.",
                              escape(with_unit(parameter))),
                  {{"method"}, {"start"}, {"kind"}, {"change"}, {"value"}, {"width"}});
  for (const CaseRecord* record : all_cases(choices.results())) {
    const auto known = [](double value) { return std::isnan(value) ? std::nullopt : std::optional(value); };
    for (const ChangeRow& row : changes_of(*record)) {
      table.row(choices.short_name(*record)).text(row.start).text(row.kind).text(row.from + " → " + row.to);
      table.number(known(row.value), 9).number(known(row.high - row.low), 2);
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

std::string agreement_html(const Choices& choices) {
  const std::vector<AgreementRow> rows = agreement_type().read(choices.results().derived);
  if (rows.empty()) return "";
  const std::vector<std::string> cases = distinct(rows, &AgreementRow::id),
                                 others = distinct(rows, &AgreementRow::other);
  std::map<std::pair<std::string, std::string>, const AgreementRow*> place;
  for (const AgreementRow& row : rows) place[{row.id, row.other}] = &row;
  HtmlTable table("Values and starts at which two methods find the same class, in per cent of those that both decide.",
                  {{"method"}}, "matrix heat");
  for (size_t k = 0; k < others.size(); ++k) table.add({std::to_string(k + 1), true, choices.name_of(others[k])});
  for (const std::string& one : cases) {
    const auto number = std::find(others.begin(), others.end(), one) - others.begin() + 1;
    table.row(fmt::format("{} {}", number, choices.name_of(one)));
    for (const std::string& other : others) {
      const auto found = place.find({one, other});
      if (found == place.end() || !found->second->share) {
        table.absent();
        continue;
      }
      const AgreementRow& row = *found->second;
      table.cell(
          fmt::format("{:.0f}", 100 * *row.share),
          fmt::format(
              " class=\"number\" style=\"{}\" title=\"{} and {}: the same class in {} of {} values and starts{}\"",
              heat_style(std::clamp(*row.share, 0.0, 1.0)), escape(choices.name_of(one)),
              escape(choices.name_of(other)), number_text(row.same), number_text(row.compared),
              row.share_attractor ? ", the same attractor in " + share_text(*row.share_attractor) : ""));
    }
  }
  return titled("Agreement of methods", table);
}

}  // namespace

std::string dynamics_tables_html(const Choices& choices) {
  const Quantity parameter = swept_parameter(choices.results());
  return attractors_html(choices.results()) + agreement_html(choices) + shifts_html(choices, parameter) +
         changes_html(choices, parameter);
}

}  // namespace ricochet::report
