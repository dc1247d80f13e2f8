#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <ricochet/contract/errors.hpp>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/execution/march_point.hpp"
#include "runners/execution/orbit_entries.hpp"
#include "runners/store/csv.hpp"
#include "runners/store/store.hpp"
#include "runners/study/load_study.hpp"

namespace ricochet {
namespace {

constexpr int default_periods = 8, default_samples = 200;
constexpr std::size_t neighbours = 5;
constexpr double same_value = 1e-9;  // relative

using Row = std::vector<nlohmann::ordered_json>;

// The one case whose id begins so.
const CaseRecord& find_case(const StudyResults& results, const std::string& id) {
  std::vector<const CaseRecord*> found;
  std::vector<std::string> ids;
  for (const CaseRecord& record : results.cases) {
    if (record.id == id) return record;
    if (record.id.starts_with(id)) found.push_back(&record);
    ids.push_back(record.id);
  }
  if (found.size() == 1) return *found.front();
  std::vector<std::string> named;
  for (const CaseRecord* record : found) named.push_back(record->id);
  if (!found.empty()) throw UsageError(fmt::format("the case \"{}\" is one of {}", id, fmt::join(named, ", ")));
  const std::string nearest = nearest_name(id, ids);
  throw UsageError(fmt::format("there is no case \"{}\"{}; its cases are {}", id,
                               nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?", fmt::join(ids, ", ")));
}

// The rows of a case's table `values`, read by column.
class Values {
 public:
  explicit Values(const CaseRecord& record) {
    for (const DerivedTable& table : record.tables)
      if (table.name == "values") table_ = &table;
    if (!table_)
      throw UsageError(fmt::format("the case {} has no values: it is {}{}", record.id, record.status,
                                   record.reason.empty() ? "" : ", " + record.reason));
  }
  std::size_t rows() const { return table_->rows.size(); }
  nlohmann::ordered_json cell(std::size_t row, const std::string& column) const {
    const auto found = std::find(table_->columns.begin(), table_->columns.end(), column);
    if (found == table_->columns.end()) return nullptr;
    return table_->rows[row].at(static_cast<std::size_t>(found - table_->columns.begin()));
  }
  double parameter(std::size_t row) const { return cell(row, "parameter").get<double>(); }
  std::string text(std::size_t row, const std::string& column) const { return csv_value(cell(row, column)); }

 private:
  const DerivedTable* table_ = nullptr;
};

std::size_t find_row(const Values& values, double wanted, const std::string& start) {
  std::vector<std::string> starts;
  std::vector<std::size_t> rows;  // of this start
  for (std::size_t row = 0; row < values.rows(); ++row) {
    const std::string name = values.text(row, "start");
    if (std::find(starts.begin(), starts.end(), name) == starts.end()) starts.push_back(name);
    if (name == start) rows.push_back(row);
  }
  if (rows.empty()) {
    const std::string nearest = nearest_name(start, starts);
    throw UsageError(fmt::format("the case has no start \"{}\"{}; its starts are {}", start,
                                 nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?",
                                 fmt::join(starts, ", ")));
  }
  const auto distance = [&](std::size_t row) { return std::abs(values.parameter(row) - wanted); };
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
  const double nearest = values.parameter(rows.front());
  if (distance(rows.front()) <= same_value * std::max(std::abs(nearest), std::abs(wanted))) return rows.front();
  std::vector<double> near;
  for (std::size_t i = 0; i < std::min(neighbours, rows.size()); ++i) near.push_back(values.parameter(rows[i]));
  std::sort(near.begin(), near.end());
  std::vector<std::string> named;
  for (const double value : near) named.push_back(csv_number(value));
  throw UsageError(fmt::format("no orbit from \"{}\" was marched at {}; the nearest values are {}", start,
                               csv_number(wanted), fmt::join(named, ", ")));
}

// "periodic 1; 2 impacts per period; exponent_1 -0.31 in [-0.32, -0.3] 1/s (tangent)".
std::string description(const Values& values, std::size_t row) {
  std::string text = values.text(row, "class");
  if (const std::string period = values.text(row, "period"); !period.empty() && text == "periodic")
    text += " " + period;
  if (const std::string impacts = values.text(row, "impacts_per_period"); !impacts.empty())
    text += fmt::format("; {} impacts per period", impacts);
  for (int k = 1; !values.text(row, fmt::format("exponent_{}", k)).empty(); ++k)
    text += fmt::format("; exponent_{} {} in [{}, {}] 1/s", k, values.text(row, fmt::format("exponent_{}", k)),
                        values.text(row, fmt::format("exponent_{}_low", k)),
                        values.text(row, fmt::format("exponent_{}_high", k)));
  if (const std::string method = values.text(row, "exponent_method"); !method.empty()) text += " (" + method + ")";
  return text;
}

// The displacements that the run stored at the strobes of one orbit; empty where the section is another one.
std::vector<double> stored_strobes(const CaseRecord& record, const StudyCase& study_case, double parameter,
                                   const std::string& start) {
  std::vector<double> strobes;
  if (study_case.settings.at("section") != "strobe") return strobes;
  for (const NumberTable& table : record.numbers) {
    if (table.name != "points" || table.words.empty()) continue;
    const auto& starts = table.words.front().second;
    const auto word = std::find(starts.begin(), starts.end(), start) - starts.begin();
    for (std::size_t i = 0; i < table.rows(); ++i)
      if (table.columns[0][i] == parameter && table.columns[1][i] == static_cast<double>(word))
        strobes.push_back(table.columns[3][i]);
  }
  return strobes;
}

}  // namespace

int command_point(const Arguments& arguments, std::ostream& out) {
  if (!arguments.parameter || arguments.start.empty())
    throw UsageError("ricochet point: expected --parameter VALUE and --start NAME, as in values.csv");
  const StudyResults results = read_store(arguments.operands[0]);
  if (results.kind != "bifurcation")
    throw UsageError(fmt::format("{} holds a study of kind {}; a point is one of kind bifurcation",
                                 arguments.operands[0], results.kind));
  const CaseRecord& record = find_case(results, arguments.operands[1]);
  const Values values(record);
  const std::size_t row = find_row(values, *arguments.parameter, arguments.start);
  if (const std::string status = values.text(row, "status"); status != "done")
    throw UsageError(fmt::format("this orbit is {}: {}", status, values.text(row, "reason")));
  PointTask task;
  task.parameter = values.parameter(row);
  task.start = arguments.start;
  task.periods = arguments.periods > 0 ? arguments.periods : default_periods;
  task.samples = arguments.samples > 0 ? arguments.samples : default_samples;
  auto entry = find_entry(record, task.parameter, task.start);
  if (!entry)
    throw UsageError(record.partial ? "the case is still running: its states are kept when it ends"
                                    : "this case keeps no states of its orbits, there are too many; run the study with "
                                      "fewer values or starts");
  task.entry = std::move(*entry);

  Catalogue catalogue = Catalogue::standard(arguments.plugins);
  Registry registry;
  const Study study = parse_study(results.study.dump(), catalogue, registry);
  const auto study_case =
      std::find_if(study.cases.begin(), study.cases.end(), [&](const StudyCase& one) { return one.id == record.id; });
  if (study_case == study.cases.end())
    throw UsageError(fmt::format("the stored study has no case {} any more: run it again", record.id));
  const std::vector<double> stored = stored_strobes(record, *study_case, task.parameter, task.start);
  std::size_t compared = 0, equal = 0;
  out << "t,tip_displacement,tip_velocity\n";
  march_point(*study_case, registry, task, [&](const PointSample& sample) {
    out << csv_number(sample.time) << ',' << csv_number(sample.displacement) << ',' << csv_number(sample.velocity)
        << '\n';
    if (sample.strobe < 0 || static_cast<std::size_t>(sample.strobe) >= stored.size()) return;
    ++compared;
    equal += sample.displacement == stored[static_cast<std::size_t>(sample.strobe)];
  });
  std::cerr << description(values, row);
  if (compared > 0) std::cerr << fmt::format("; {} of {} strobes as stored", equal, compared);
  if (equal < compared) std::cerr << ": the results are of another build of the program";
  std::cerr << "\n";
  return exit_done;
}

}  // namespace ricochet
