#include "runners/kinds/trajectory/page/orbits.hpp"

#include "runners/kinds/trajectory/orbit_taker.hpp"
#include "runners/kinds/trajectory/page/stops.hpp"

namespace ricochet::report {

Table orbit_points(const CaseView& view) {
  Table out{"orbit_points",
            "One sample of a place within its clearance, of the finest case of a method.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"stop", "", "Name of the clearance."},
             {"t", "s", "Time of the sample."},
             {"first", "m", "Displacement along the first component."},
             {"second", "m", "Displacement along the second."},
             {"radius", "m", "Radius of the clearance."}},
            {}};
  constexpr std::size_t most_methods = 6, most_dots = 4000;
  std::vector<std::pair<const CaseRecord*, const NumberTable*>> tables;
  std::size_t rows = 0;
  for (const Cases& cases : methods_from_finest(answers::Compared(view.results()))) {
    const NumberTable* table = orbits_type().find(cases.front()->numbers);
    if (!table || table->rows() == 0 || tables.size() == most_methods) continue;
    tables.emplace_back(cases.front(), table);
    rows += table->rows();
  }
  const std::size_t every = std::max<std::size_t>(1, (rows + most_dots - 1) / most_dots);
  for (const auto& [record, orbits] : tables) {
    const OrbitColumns at = orbits_type().read(*orbits);
    const std::vector<std::string>& names = orbits->words.front().second;
    for (std::size_t i = 0; i < orbits->rows(); i += every)
      out.rows.push_back({record->id, names.at(static_cast<std::size_t>((*at.stop)[i])), (*at.t)[i], (*at.first)[i],
                          (*at.second)[i], (*at.radius)[i]});
  }
  return out;
}

}  // namespace ricochet::report
