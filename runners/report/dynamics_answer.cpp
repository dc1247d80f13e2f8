#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "runners/report/dynamics_report.hpp"
#include "runners/report/evidence_rows.hpp"
#include "runners/report/html.hpp"
#include "runners/report/interval.hpp"
#include "runners/report/orbits.hpp"

namespace ricochet::report {
namespace {

constexpr size_t most_sentences = 8;

/// A numerical viscosity counts as small below this share of the physical one.
constexpr double small_share = 0.01;

std::string value_text(double value, const Quantity& parameter) {
  return number_text(value, 7) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

struct Verdicts {
  std::map<std::string, double> width;  ///< by verdict, and by "depends on CHOICE"
  std::map<std::string, size_t> count;
  std::vector<std::string> sentences;
  double low = INFINITY, high = -INFINITY, total = 0;
};

Verdicts verdicts_of(const StudyResults& results) {
  const EvidenceRows rows(results, "verdicts");
  Verdicts out;
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto from = rows.number(row, "from"), to = rows.number(row, "to");
    const std::string word = rows.text(row, "verdict"), choice = rows.text(row, "choice");
    if (from && to) {
      out.low = std::min(out.low, *from);
      out.high = std::max(out.high, *to);
      out.total += *to - *from;
    }
    const std::string name = word == "depends" && !choice.empty() ? "depends on " + choice : word;
    ++out.count[name];
    if (from && to) out.width[name] += *to - *from;
    if (const std::string sentence = rows.text(row, "sentence"); !sentence.empty()) out.sentences.push_back(sentence);
  }
  return out;
}

std::string verdict_lead(const Verdicts& verdicts, const Quantity& parameter) {
  if (verdicts.count.empty()) return "";
  size_t all = 0;
  for (const auto& [name, count] : verdicts.count) all += count;
  std::string parts;
  const auto add = [&](const std::string& name) {
    const auto count = verdicts.count.find(name);
    if (count == verdicts.count.end()) return;
    const auto width = verdicts.width.find(name);
    const std::string share = width == verdicts.width.end() || verdicts.total <= 0
                                  ? ""
                                  : fmt::format(" ({} of the range)", share_text(width->second / verdicts.total));
    parts +=
        fmt::format("{}<strong>{}</strong> in {}{}", parts.empty() ? "" : "; ", escape(name), count->second, share);
  };
  add("robust");
  for (const auto& [name, count] : verdicts.count)
    if (name != "robust" && name != "undecided") add(name);
  add("undecided");
  std::string range;
  if (std::isfinite(verdicts.low))
    range = fmt::format(" of {} from {} to {}", escape(parameter.name), number_text(verdicts.low, 5),
                        value_text(verdicts.high, parameter));
  return fmt::format("<p class=\"lead\">What the methods say over {}{}: {}.</p>\n",
                     count_text(all, "interval", "intervals"), range, parts);
}

std::string sentences_html(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  std::string out = "<ul class=\"answer\">\n", rest;
  for (size_t k = 0; k < sentences.size(); ++k)
    (k < most_sentences ? out : rest) += "<li>" + escape(sentences[k]) + "</li>\n";
  out += "</ul>\n";
  if (!rest.empty())
    out += fmt::format("<details><summary>{} more</summary><ul class=\"answer\">\n{}</ul></details>\n",
                       count_text(sentences.size() - most_sentences, "interval", "intervals"), rest);
  return out;
}

/// Orbits of some cases by group.
std::array<size_t, regime_groups.size()> count_groups(const Cases& cases) {
  std::array<size_t, regime_groups.size()> out{};
  for (const CaseRecord* record : cases)
    for (const Orbit& orbit : orbits_of(*record)) ++out[regime_group(orbit)];
  return out;
}

std::string regime_sentence(const Cases& cases) {
  const auto counts = count_groups(cases);
  size_t all = 0;
  for (const size_t count : counts) all += count;
  std::string parts;
  for (size_t group = 0; group < counts.size(); ++group)
    if (counts[group] > 0)
      parts += fmt::format("{}<span class=\"swatch\" style=\"background:{}\"></span>{}: {}", parts.empty() ? "" : ", ",
                           regime_groups[group].colour, regime_groups[group].name, counts[group]);
  return fmt::format("<p>Regimes of {}: {}.</p>\n", count_text(all, "orbit", "orbits"), parts);
}

/// Where motion first touches, over the methods, for each start.
std::string grazing_sentence(const Cases& cases, const Quantity& parameter) {
  std::map<std::string, std::vector<double>> found;
  std::map<std::string, double> widest;
  for (const CaseRecord* record : cases) {
    const DerivedTable* table = case_table(*record, "bifurcations");
    if (!table) continue;
    const TableRows rows(*table);
    for (size_t row = 0; row < rows.size(); ++row) {
      const auto value = rows.number(row, "value");
      if (!value || rows.text(row, "kind") != "grazing") continue;
      const std::string start = rows.text(row, "start");
      found[start].push_back(*value);
      const auto low = rows.number(row, "low"), high = rows.number(row, "high");
      if (low && high) widest[start] = std::max(widest[start], *high - *low);
    }
  }
  std::string out;
  for (const std::string& start : starts_in(cases)) {
    const auto at = found.find(start);
    if (at == found.end()) continue;
    const auto [low, high] = std::minmax_element(at->second.begin(), at->second.end());
    const std::string text =
        *low == *high ? value_text(*low, parameter) : number_text(*low, 7) + " to " + value_text(*high, parameter);
    out += fmt::format("<p>Grazing, start {}: {} ({}; each located to {}).</p>\n", escape(start), text,
                       count_text(at->second.size(), "change", "changes"), value_text(widest[start], parameter));
  }
  return out;
}

std::optional<double> physical_viscosity(const CaseView& view, const CaseRecord& record) {
  if (const auto axis = CaseView::number(record, "structure.damping.stiffness")) return axis;
  const nlohmann::ordered_json& study = view.results().study;
  const nlohmann::ordered_json::json_pointer pointer("/scene/structure/damping/stiffness");
  if (!study.is_object() || !study.contains(pointer) || !study.at(pointer).is_number()) return std::nullopt;
  return study.at(pointer).get<double>();
}

struct Viscosity {
  Interval numerical = Interval::nothing(), physical = Interval::nothing();
  double share = 0;  ///< largest |α_eq|/α
  bool known = false, undamped = false;
};

Viscosity viscosity_of(const CaseView& view, const CaseRecord& record) {
  Viscosity out;
  const bool swept = swept_parameter(view.results()).name == "structure.damping.stiffness";
  for (const Orbit& orbit : orbits_of(record)) {
    if (!orbit.alpha_equivalent) continue;
    const auto physical = swept ? std::optional(orbit.parameter) : physical_viscosity(view, record);
    out.known = true;
    out.numerical.include(*orbit.alpha_equivalent);
    if (!physical) continue;
    out.physical.include(*physical);
    if (*physical > 0)
      out.share = std::max(out.share, std::abs(*orbit.alpha_equivalent) / *physical);
    else
      out.undamped = true;
  }
  return out;
}

std::string range_text(const Interval& range) {
  const std::string low = number_text(range.low, 3), high = number_text(range.high, 3);
  return low == high ? low : low + " to " + high;
}

/// α_eq with its share of α; below 1e-12 of it, nothing is told from round-off.
std::string viscosity_cell(const Viscosity& v) {
  if (!v.known) return "<td class=\"absent\">–</td>";
  if (v.numerical.low == 0 && v.numerical.high == 0) return "<td class=\"text\">0</td>";
  if (v.undamped || v.physical.empty())
    return fmt::format("<td class=\"warned\">{}: no α to compare with</td>", range_text(v.numerical));
  if (v.share < 1e-12) return "<td class=\"text\">0 to round-off</td>";
  const std::string text = fmt::format("{}: {} of α", range_text(v.numerical), share_text(v.share));
  if (v.share <= small_share) return "<td class=\"text\">" + text + "</td>";
  const bool feeds = v.numerical.low < 0 && -v.numerical.low >= v.numerical.high;
  return fmt::format("<td class=\"warned\">▲ {}{}</td>", text, feeds ? ", feeding energy" : "");
}

/// Methods × regimes, with the viscosity of each method.
std::string regime_table(const CaseView& view, const Cases& cases) {
  const auto all = count_groups(cases);
  std::string head;
  for (size_t group = 0; group < all.size(); ++group)
    if (all[group] > 0)
      head += fmt::format(
          "<th scope=\"col\" class=\"number\"><span class=\"swatch\" style=\"background:{}\"></span>{}</th>",
          regime_groups[group].colour, regime_groups[group].name);
  std::vector<Viscosity> viscosities;
  Interval physical = Interval::nothing();
  bool any = false;
  size_t not_small = 0, known = 0;
  for (const CaseRecord* record : cases) {
    viscosities.push_back(viscosity_of(view, *record));
    const Viscosity& v = viscosities.back();
    physical.include(v.physical);
    any = any || v.known;
    known += v.known;
    not_small += v.share > small_share;
  }
  std::string rows;
  for (size_t c = 0; c < cases.size(); ++c) {
    const CaseRecord* record = cases[c];
    const auto counts = count_groups({record});
    size_t total = 0;
    for (const size_t count : counts) total += count;
    std::string cells;
    for (size_t group = 0; group < all.size(); ++group)
      if (all[group] > 0)
        cells += counts[group] == 0
                     ? "<td class=\"number absent\">–</td>"
                     : fmt::format("<td class=\"number\" title=\"{}\">{}</td>",
                                   share_text(static_cast<double>(counts[group]) / static_cast<double>(total)),
                                   counts[group]);
    const std::string label = view.label(*record);
    rows +=
        fmt::format("<tr><th scope=\"row\">{}{}</th>{}{}</tr>\n", escape(label.empty() ? "the one method" : label),
                    is_partial(*record) ? " <em>(partial)</em>" : "", cells, any ? viscosity_cell(viscosities[c]) : "");
  }
  std::string caption = "Orbits (values × starts) by regime.";
  if (any)
    caption += fmt::format(
        " α_eq: the stiffness viscosity (s) that the scheme adds to α = {} of the scene, fitted on the free decay of "
        "the "
        "first modes. ▲: more than {} of α, so not ≪ α: {} of {} methods.",
        physical.empty() ? "0" : range_text(physical) + " s", share_text(small_share), not_small, known);
  return fmt::format(
      "<div class=\"scroll{}\"><table class=\"matrix\"><caption>{}</caption>\n<thead><tr><th "
      "scope=\"col\">method</th>{}{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      cases.size() > 24 ? " tall" : "", caption, head, any ? "<th scope=\"col\">α_eq</th>" : "", rows);
}

}  // namespace

std::string dynamics_answer_html(const CaseView& view) {
  if (view.results().kind != "bifurcation") return "";
  Cases cases;
  for (const CaseRecord* record : view.all())
    if (!orbits_of(*record).empty()) cases.push_back(record);
  if (cases.empty()) return "";
  const Quantity parameter = swept_parameter(view.results());
  const Verdicts verdicts = verdicts_of(view.results());
  std::string out = verdict_lead(verdicts, parameter);
  out += regime_sentence(cases) + grazing_sentence(cases, parameter);
  return out + sentences_html(verdicts.sentences) + regime_table(view, cases);
}

}  // namespace ricochet::report
