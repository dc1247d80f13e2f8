#include <set>

#include "runners/kinds/stability/page/page.hpp"
#include "runners/report/html.hpp"
#include "runners/report/html_table.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {

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

}  // namespace ricochet::report
