#include <cmath>

#include "runners/kinds/trajectory/page/page.hpp"

namespace ricochet::report {

Table energy_changes(const CaseView& view) {
  Table out{"energy_changes",
            "One row per case: where its energy ends, told from its start.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"change", "1", "Distance of the energy left from 1."},
             {"gained", "", "Whether the energy grew."},
             {"conservative", "", "Whether nothing but contact and the method changes energies in this study."}},
            {}};
  const bool kept = conservative(view);
  for (const CaseRecord* record : view.all())
    if (const auto ratio = ricochet::measure(*record, "energy_left"))
      out.rows.push_back({record->id, std::abs(*ratio - 1), *ratio > 1, kept});
  return out;
}

}  // namespace ricochet::report
