#include "runners/kinds/trajectory/page/page.hpp"

#include <cmath>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/kinds/trajectory/page/orbits.hpp"
#include "runners/kinds/trajectory/page/stops.hpp"
#include "runners/kinds/trajectory/page/summary_measures.hpp"

namespace ricochet::report {

KindPage trajectory_page() {
  KindPage page;
  page.scripts = scripts({"along_axis", "over_time", "final_energy", "energy", "tip", "force", "penetration", "impacts",
                          "shocks", "clearances", "spectra"});
  page.tables = {"energy_changes", "shock_points", "orbit_points", "spectrum_bands"};
  page.curves = {"energy", "tip_displacement", "contact_force_peak"};
  page.derived = {energy_changes, shock_points, orbit_points, spectrum_bands};
  page.answer = [](const CaseView& view) {
    return answers::evidence_html(answers::Compared(view.results())) + stops_html(view);
  };
  page.summary = summary_measures_html;
  return page;
}

Table energy_changes(const CaseView& view) {
  Table out{"energy_changes",
            "One row per case: where its energy ends, told from its start.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"change", "1", "Distance of the energy left from 1."},
             {"gained", "", "Whether the energy grew."},
             {"conservative", "", "Whether nothing but contact and the method changes energies in this study."}},
            {}};
  const bool kept = answers::keeps_energy(view.results());
  for (const CaseRecord* record : view.all())
    if (const auto ratio = ricochet::measure(*record, "energy_left"))
      out.rows.push_back({record->id, std::abs(*ratio - 1), *ratio > 1, kept});
  return out;
}

}  // namespace ricochet::report
