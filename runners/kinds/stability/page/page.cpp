#include <fmt/format.h>

#include <set>

#include "runners/kinds/stability/stability.hpp"
#include "runners/kinds/stability/stability_tables.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/kind_page.hpp"

namespace ricochet::report {

KindPage stability_page() {
  KindPage page;
  page.scripts = scripts({"stability_tables", "limit_dots", "spectral_radius", "stability_map"});
  page.tables = {"stability_cells", "step_limits", "stability_disagreements"};
  page.answer = [](const Choices& choices) { return stability_html(choices) + restitution_html(choices); };
  return page;
}

std::string restitution_html(const Choices& choices) {
  HtmlTable table(
      "What a free mass keeps of its speed at a rigid stop, over the phases of the step at which it arrives. It "
      "follows from the plan of each scheme alone. Beyond 1 the mass is thrown back faster than it came. ρ∞: what a "
      "step leaves of the highest frequencies.",
      {{"time scheme"}, {"least", true}, {"mean", true}, {"most", true}, {"ρ∞", true}});
  // It depends on the scheme alone: one row for cases that differ in the rest.
  const auto columns = choices.varying_without({"mass", "contact", "elements"});
  std::set<std::string> said;
  for (const RestitutionRow& row : restitution_type().read(choices.results().derived)) {
    const CaseRecord* record = choices.find(row.id);
    if (!record || !said.insert(choices.short_label(*record, columns)).second) continue;
    table.row(choices.short_name(*record, columns));
    for (const auto& value : {row.least, row.mean, row.most, row.rho_inf})
      table.number(value ? number_text(*value, 3) : "–");
  }
  return table.size() > 0 ? table.html() : "";
}

namespace {

std::string limit_text(const std::optional<double>& limit, RangeLimit where) {
  return limit ? number_text(*limit, 5) : where == RangeLimit::not_made ? "–" : word(where);
}

/// Marginal roots, then what grows at the smallest step that is not stable, or why there is no prediction. The map
/// shows what was seen there.
std::string why(const LimitRow& row) {
  if (row.grows.empty() || !row.first_unstable) return row.marginal;
  return row.marginal + (row.marginal.empty() ? "" : "; ") +
         (row.refused == true ? row.grows
                              : fmt::format("h = {} s: {}", number_text(*row.first_unstable, 3), row.grows));
}

}  // namespace

std::string stability_html(const Choices& choices) {
  HtmlTable table(
      "Step limits in seconds. Open: the structure alone. Closed: predicted with points held on both sides, the worst "
      "of several sets. It is observed in the scene itself, which is open as well: the ratio is to the smaller of both "
      "predictions.",
      {{"method"},
       {"contact"},
       {"predicted limit", true},
       {"observed limit", true},
       {"observed / predicted", true},
       {"marginal roots, and what grows at the first step that is not stable"}});
  for (const LimitRow& row : step_limits_type().read(choices.results().derived)) {
    const CaseRecord* record = choices.find(row.id);
    if (!record || !row.counted) continue;
    const auto columns = row.closed ? choices.varying() : choices.varying_without({"contact"});
    table.row(choices.short_name(*record, columns), choices.colour(*record)).text(row.closed ? "closed" : "open");
    table.number(limit_text(row.predicted, row.prediction)).number(limit_text(row.observed, row.observation));
    table.number(row.ratio ? number_text(*row.ratio, 4) : "–").text(why(row), "reason");
  }
  if (table.size() == 0) return "";
  return table.html();
}

}  // namespace ricochet::report
