#include "runners/kinds/stability/page/page.hpp"

#include <fmt/format.h>

#include <set>

#include "runners/report/html.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

KindPage stability_page() {
  KindPage page;
  page.scripts = scripts({"stability_tables", "limit_dots", "spectral_radius", "stability_map"});
  page.tables = {"stability_cells", "step_limits", "stability_disagreements"};
  page.answer = [](const CaseView& view) { return stability_html(view) + restitution_html(view); };
  return page;
}

std::string restitution_html(const CaseView& view) {
  const Table* restitution = find_table(view.results().derived, "restitution");
  if (!restitution) return "";
  HtmlTable table(
      "What a free mass keeps of its speed at a rigid stop, from the plan of each scheme alone: over the phases of the "
      "step at which it arrives. Beyond 1 it is thrown back faster than it came. ρ∞: what a step leaves of the highest "
      "frequencies.",
      {{"time scheme"}, {"least", true}, {"mean", true}, {"most", true}, {"ρ∞", true}});
  // It depends on the scheme alone: one row for cases that differ in the rest.
  const auto columns = view.varying_without({"mass", "contact", "elements"});
  std::set<std::string> said;
  const TableReader rows(*restitution);
  for (size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* record = view.find(rows.text(row, "case"));
    if (!record || !said.insert(view.label(*record, columns)).second) continue;
    table.row(view.name(*record, columns));
    for (const char* column : {"least", "mean", "most", "rho_inf"}) {
      const auto value = rows.number(row, column);
      table.number(value ? number_text(*value, 3) : "–");
    }
  }
  return table.size() > 0 ? table.html() : "";
}

namespace {

std::string limit_text(const TableReader& rows, size_t row, const char* limit, const char* where) {
  if (const auto step = rows.number(row, limit)) return number_text(*step, 5);
  const std::string said = rows.text(row, where);
  return said.empty() ? "–" : said;
}

/// Marginal roots, then what grows at the smallest step that is not stable, or why there is no prediction; what was
/// seen there is left to the map.
std::string why(const TableReader& rows, size_t row) {
  std::string out = rows.text(row, "marginal");
  const std::string grows = rows.text(row, "grows");
  const auto step = rows.number(row, "first_unstable");
  if (grows.empty() || !step) return out;
  return out + (out.empty() ? "" : "; ") +
         (rows.truth(row, "refused") == true ? grows : fmt::format("h = {} s: {}", number_text(*step, 3), grows));
}

}  // namespace

std::string stability_html(const CaseView& view) {
  const Table* limits = find_table(view.results().derived, "step_limits");
  if (!limits) return "";
  const TableReader rows(*limits);
  HtmlTable table(
      "Step limits in seconds. Open: the structure alone. Closed: predicted with points held on both sides, the worst "
      "of several sets; observed in the scene itself, which is open as well: the ratio is to the smaller of both "
      "predictions.",
      {{"method"},
       {"contact"},
       {"predicted limit", true},
       {"observed limit", true},
       {"observed / predicted", true},
       {"marginal roots, and what grows at the first step that is not stable"}});
  for (size_t row = 0; row < rows.size(); ++row) {
    const CaseRecord* record = view.find(rows.text(row, "case"));
    if (!record || rows.truth(row, "counted") != true) continue;
    const bool closed = rows.truth(row, "closed") == true;
    const auto columns = closed ? view.varying() : view.varying_without({"contact"});
    const auto ratio = rows.number(row, "ratio");
    table.row(view.name(*record, columns), view.colour(*record)).text(closed ? "closed" : "open");
    table.number(limit_text(rows, row, "predicted", "prediction"));
    table.number(limit_text(rows, row, "observed", "observation"));
    table.number(ratio ? number_text(*ratio, 4) : "–").text(why(rows, row), "reason");
  }
  if (table.size() == 0) return "";
  return table.html();
}

}  // namespace ricochet::report
