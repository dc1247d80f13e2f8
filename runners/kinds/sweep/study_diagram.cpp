#include <algorithm>
#include <cmath>
#include <ricochet/measure/attractors/diagram.hpp>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::dynamics {
namespace {

/// Points of a cycle closer than this (in units of the spread) are one.
constexpr double kSamePoint = 1e-3;
constexpr std::size_t kLargestCycle = 64;
constexpr double kNoWord = -1;

/// Index of a start; new ones are added.
int start_in(std::vector<DiagramStart>& starts, const std::string& name) {
  const auto found =
      std::find_if(starts.begin(), starts.end(), [&](const DiagramStart& start) { return start.name == name; });
  if (found != starts.end()) return static_cast<int>(found - starts.begin());
  starts.push_back({name, is_random_start(name)});
  return static_cast<int>(starts.size()) - 1;
}

void read_runs(StudyDiagram& study, DiagramSource& source, DiagramCase& owner) {
  source.orbits = orbits_in(*source.table);
  for (std::size_t r = 0; r < source.orbits.size(); ++r) {
    const OrbitRow& orbit = source.orbits[r];
    if (std::isnan(orbit.parameter)) continue;
    DiagramRun run;
    run.parameter = orbit.parameter;
    run.start = start_in(study.diagram.starts, orbit.start);
    run.status = orbit.status.empty() ? word(Status::done) : orbit.status;
    run.settled = orbit.done();
    run.motion = motion_of(orbit.regime, orbit.period, run.status);
    if (orbit.period && *orbit.period >= 1) run.period = *orbit.period;
    run.open = orbit.open.value_or(0);
    run.symmetric = orbit.symmetric;
    run.viscosity = orbit.alpha_equivalent;
    source.rows.push_back(r);
    owner.runs.push_back(std::move(run));
  }
}

/// Of the contact law of a case, as its law declares it; not known of stores of versions that did not keep it.
std::optional<double> compliance_of(const CaseRecord& record) {
  const NumberTable* table = contact_law_type().find(record.numbers);
  if (!table || table->rows() != 1 || !std::isfinite(table->values.front().front())) return std::nullopt;
  return table->values.front().front();
}

}  // namespace

SectionIndex SectionIndex::of_orbits(const CaseRecord& record) {
  const NumberType<SectionColumns> type = points_type();
  const NumberTable* table = type.find(record.numbers);
  if (!table) return {};
  const SectionColumns columns = type.read(*table);
  return columns.start ? SectionIndex(table, columns, columns.parameter, columns.start) : SectionIndex();
}

SectionIndex SectionIndex::of_cells(const CaseRecord& record) {
  const NumberType<SectionColumns> type = cell_points_type();
  const NumberTable* table = type.find(record.numbers);
  if (!table) return {};
  const SectionColumns columns = type.read(*table);
  return SectionIndex(table, columns, columns.cell);
}

SectionIndex::SectionIndex(const NumberTable* table, const SectionColumns& columns, const Series* keys,
                           const Series* second)
    : table_(table), columns_(columns) {
  if (!keys) return;
  if (second) words_ = table->words_of(start_name);
  keys->each([&](std::size_t row, double value) {
    const double index = second ? second->at(row) : kNoWord;
    if (std::isnan(value) || std::isnan(index)) return;
    if (!ranges_.empty() && ranges_.back().key == value && ranges_.back().word == index && ranges_.back().last == row)
      ++ranges_.back().last;
    else
      ranges_.push_back({value, index, row, row + 1});
  });
  std::stable_sort(ranges_.begin(), ranges_.end(), before);
}

bool SectionIndex::before(const Range& a, const Range& b) {
  return std::pair(a.key, a.word) < std::pair(b.key, b.word);
}

void SectionIndex::add_points(ScaleOfPoints& scale) const {
  for (const double sign : {1.0, -1.0}) {
    const Series* x = sign > 0 ? columns_.displacement : columns_.opposite_displacement;
    const Series* v = sign > 0 ? columns_.velocity : columns_.opposite_velocity;
    if (!x || !v) return;
    x->each([&](std::size_t row, double value) { scale.add({sign * value, sign * v->at(row)}); });
  }
}

SectionReadings SectionIndex::read(double key, const std::string& word) const {
  SectionReadings out;
  const Series *x = columns_.displacement, *v = columns_.velocity;
  double index = kNoWord;
  if (words_) index = static_cast<double>(std::find(words_->begin(), words_->end(), word) - words_->begin());
  const auto [first, last] = std::equal_range(ranges_.begin(), ranges_.end(), Range{key, index, 0, 0}, before);
  if (first == last || !x || !v) return out;
  const Series *ox = columns_.opposite_displacement, *ov = columns_.opposite_velocity;
  bool whole = ox && ov;
  for (auto range = first; range != last; ++range)
    for (std::size_t k = range->first; k < range->last; ++k) {
      const CloudPoint point{x->at(k), v->at(k)};
      if (!std::isfinite(point[0]) || !std::isfinite(point[1])) continue;
      out.points.push_back(point);
      if (!whole) continue;
      const CloudPoint opposite{ox->at(k), ov->at(k)};
      whole = std::isfinite(opposite[0]) && std::isfinite(opposite[1]);
      if (whole) out.opposite.push_back(opposite);
    }
  if (!whole) out.opposite.clear();
  return out;
}

StudyDiagram read_diagram(const StudyResults& results) {
  StudyDiagram study;
  study.results = &results;
  study.swept = swept_columns(results);
  study.parameter = swept_name(results);
  const auto section = results.study.find("section");
  study.strobed = section == results.study.end() || !section->is_string() || *section == "strobe";
  std::vector<const CaseRecord*> records;
  for (const CaseRecord& record : results.cases) {
    const Table* table = find_table(record.tables, "values");
    if (!table) continue;
    records.push_back(&record);
    DiagramSource& source = study.sources.emplace_back(DiagramSource{&record, table, SectionIndex::of_orbits(record)});
    DiagramCase& owner = study.diagram.cases.emplace_back();
    owner.compliance = compliance_of(record);
    owner.steps_per_period = axis(record, "steps_per_period").number().value_or(0);
    owner.elements = axis(record, "elements").number().value_or(0);
    owner.modes = axis(record, "modes").number().value_or(INFINITY);
    read_runs(study, source, owner);
  }
  study.diagram.number_values();
  ScaleOfPoints scale;
  for (const DiagramSource& source : study.sources) source.sections.add_points(scale);
  study.scale = scale.scale();
  study.axes = axes_of(results, records);
  return study;
}

SettledSection settled_section(const StudyDiagram& study, std::size_t case_index, const DiagramRun& run) {
  const SectionReadings readings = study.sources[case_index].sections.read(
      run.parameter, study.diagram.starts[static_cast<std::size_t>(run.start)].name);
  const int cycle = run.cycle();
  SettledSection out{run.motion, {}};
  if (cycle == 0 || study.strobed) {
    out.cloud = make_cloud(readings.points, readings.opposite, study.scale, cycle, run.open);
    return out;
  }
  // Impacts or extrema: how many there are in a cycle is seen from the points themselves.
  const auto half = [&](const std::vector<CloudPoint>& points) {
    std::vector<CloudPoint> last;
    for (std::size_t k = points.size() / 2; k < points.size(); ++k)
      last.push_back({points[k][0] / study.scale[0], points[k][1] / study.scale[1]});
    return distinct_points(last, kSamePoint);
  };
  out.cloud.points = half(readings.points);
  out.cloud.opposite = half(readings.opposite);
  if (out.cloud.points.size() > kLargestCycle || out.cloud.opposite.size() > kLargestCycle)
    out.cloud = make_cloud(readings.points, readings.opposite, study.scale, 0);
  return out;
}

HalvesNull null_of(const StudyDiagram& study, std::size_t case_index, const DiagramRun& run) {
  const SectionReadings readings = study.sources[case_index].sections.read(
      run.parameter, study.diagram.starts[static_cast<std::size_t>(run.start)].name);
  return null_of_halves(readings.points, study.scale, study.strobed ? run.cycle() : 0);
}

std::optional<double> viscosity_of(const StudyResults& results, const CaseRecord& record, double parameter) {
  const std::string path = "structure.damping.stiffness";
  if (swept_name(results) == path) return parameter;
  if (const auto value = axis(record, path).number()) return value;
  const Json::json_pointer pointer("/scene/structure/damping/stiffness");
  return results.study.contains(pointer) ? cell_of(results.study.at(pointer)).number() : std::nullopt;
}

MotionClass motion_of(const std::string& regime, std::optional<double> period, const std::string& status) {
  if (status != word(Status::done)) return {Regime::failed};
  return motion_class(regime, period).value_or(MotionClass{});
}

std::vector<ChoiceAxis> axes_of(const StudyResults& results, const std::vector<const CaseRecord*>& cases) {
  std::vector<ChoiceAxis> axes;
  for (const std::string& column : results.columns) {
    ChoiceAxis choice{column, {}};
    for (const CaseRecord* record : cases) choice.levels.push_back(ricochet::axis(*record, column).text());
    axes.push_back(std::move(choice));
  }
  return axes;
}

}  // namespace ricochet::dynamics
