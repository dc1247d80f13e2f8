#include "runners/kinds/bifurcation/point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <ricochet/contract/errors.hpp>

#include "runners/kinds/sweep/orbit_entries.hpp"
#include "runners/kinds/sweep/stored_case.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/table/csv_text.hpp"

namespace ricochet {
namespace {

const OrbitRow& find_orbit(const std::vector<OrbitRow>& orbits, double wanted, const std::string& start) {
  std::vector<std::string> starts;
  std::vector<double> marched;  // from this start
  for (const OrbitRow& orbit : orbits) {
    if (std::find(starts.begin(), starts.end(), orbit.start) == starts.end()) starts.push_back(orbit.start);
    if (orbit.start != start) continue;
    marched.push_back(orbit.parameter);
    if (is_value(orbit.parameter, wanted)) return orbit;
  }
  if (!marched.empty())
    throw PointRefused(fmt::format("no orbit from \"{}\" was marched at {}; the nearest values are {}", start, wanted,
                                   nearest_values(marched, wanted)));
  const std::string nearest = nearest_name(start, starts);
  throw PointRefused(fmt::format("the case has no start \"{}\"{}; its starts are {}", start,
                                 nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?",
                                 fmt::join(starts, ", ")));
}

// "periodic 1; 2 impacts per period; exponent_1 -0.31 in [-0.32, -0.3] 1/s (tangent)".
std::string description(const OrbitRow& orbit) {
  std::string text = regime_text(orbit.regime, orbit.period);
  if (orbit.impacts_per_period) text += fmt::format("; {} impacts per period", csv_number(*orbit.impacts_per_period));
  for (std::size_t k = 0; k < orbit.exponents.size() && orbit.exponents[k].value; ++k)
    text += fmt::format("; exponent_{} {} in [{}, {}] 1/s", k + 1, csv_number(*orbit.exponents[k].value),
                        Cell(orbit.exponents[k].low).text(), Cell(orbit.exponents[k].high).text());
  if (!orbit.exponent_method.empty()) text += " (" + orbit.exponent_method + ")";
  return text;
}

}  // namespace

int march_orbit_again(const StudyResults& results, const PointRequest& asked, std::ostream& out) {
  if (!asked.parameter || asked.start.empty() || !asked.cell.empty())
    throw PointRefused(
        "ricochet point: this is a study of kind bifurcation; expected --parameter VALUE and --start NAME, as in "
        "values.csv");
  const CaseRecord& record = find_case(results, asked.case_id);
  const std::vector<OrbitRow> orbits = orbits_in(stored_table(record, "values"));
  const OrbitRow& orbit = find_orbit(orbits, *asked.parameter, asked.start);
  if (!orbit.done()) throw PointRefused(fmt::format("this orbit is {}: {}", orbit.status, orbit.reason));
  PointTask task;
  task.parameter = orbit.parameter;
  task.start = asked.start;
  task.count = wanted_count(asked);
  auto entry = find_entry(record, task.parameter, task.start);
  if (!entry)
    throw PointRefused(record.partial
                           ? "the case is still running: its states are kept when it ends"
                           : "this case keeps no states of its orbits, there are too many; run the study with "
                             "fewer values or starts");
  task.entry = std::move(*entry);

  const StoredStudy stored(results, asked.plugins);
  const StudyCase& study_case = stored.find(record.id);
  std::vector<double> strobes;  // as the run stored them; none where its section is another one
  if (study_case.settings.at("section") == "strobe")
    strobes = orbit_numbers(record, "points", "tip_displacement", task.parameter, task.start);
  std::size_t compared = 0, equal = 0;
  SamplePrinter print(out);
  march_point(study_case, stored.registry, task, [&](const PointSample& sample) {
    print(sample);
    if (sample.strobe < 0 || static_cast<std::size_t>(sample.strobe) >= strobes.size()) return;
    ++compared;
    equal += sample.displacement == strobes[static_cast<std::size_t>(sample.strobe)];
  });
  std::cerr << description(orbit) << comparison_text(equal, compared) << "\n";
  return 0;
}

}  // namespace ricochet
