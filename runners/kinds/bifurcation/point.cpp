#include "runners/kinds/bifurcation/point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <ricochet/contract/errors.hpp>

#include "runners/kinds/sweep/orbit_entries.hpp"
#include "runners/kinds/sweep/stored_case.hpp"

namespace ricochet {
namespace {

std::size_t find_row(const TableReader& values, double wanted, const std::string& start) {
  std::vector<std::string> starts;
  std::vector<double> marched;  // from this start
  const std::size_t starting = values.column("start"), parameter = values.column("parameter");
  for (std::size_t row = 0; row < values.size(); ++row) {
    const std::string name = values.text(row, starting);
    if (std::find(starts.begin(), starts.end(), name) == starts.end()) starts.push_back(name);
    if (name != start) continue;
    marched.push_back(values.number(row, parameter).value());
    if (is_value(marched.back(), wanted)) return row;
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
std::string description(const TableReader& values, std::size_t row) {
  std::string text = stored_regime(values, row);
  if (const std::string impacts = values.text(row, "impacts_per_period"); !impacts.empty())
    text += fmt::format("; {} impacts per period", impacts);
  for (int k = 1;; ++k) {
    const std::string name = fmt::format("exponent_{}", k);
    const std::string exponent = values.text(row, values.column_if_any(name));
    if (exponent.empty()) break;
    text += fmt::format("; {} {} in [{}, {}] 1/s", name, exponent, values.text(row, name + "_low"),
                        values.text(row, name + "_high"));
  }
  if (const std::string method = values.text(row, "exponent_method"); !method.empty()) text += " (" + method + ")";
  return text;
}

}  // namespace

int march_orbit_again(const StudyResults& results, const PointRequest& asked, std::ostream& out) {
  if (!asked.parameter || asked.start.empty() || !asked.cell.empty())
    throw PointRefused(
        "ricochet point: this is a study of kind bifurcation; expected --parameter VALUE and --start NAME, as in "
        "values.csv");
  const CaseRecord& record = find_case(results, asked.case_id);
  const TableReader values(stored_table(record, "values"));
  const std::size_t row = find_row(values, *asked.parameter, asked.start);
  if (const std::string status = values.text(row, "status"); status != "done")
    throw PointRefused(fmt::format("this orbit is {}: {}", status, values.text(row, "reason")));
  PointTask task;
  task.parameter = values.number(row, "parameter").value();
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
  std::cerr << description(values, row) << comparison_text(equal, compared) << "\n";
  return 0;
}

}  // namespace ricochet
