#include "runners/kinds/sweep/derive_dynamics_diagram.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace ricochet::dynamics {
namespace {

/// Points of a cycle closer than this (in units of the spread) are one.
constexpr double kSamePoint = 1e-3;
constexpr std::size_t kLargestCycle = 64;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::string axis_text(const Json& value) {
  return value.is_null() ? "" : (value.is_string() ? value.get<std::string>() : value.dump());
}

int index_in(std::vector<std::string>& words, const std::string& word) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  words.push_back(word);
  return static_cast<int>(words.size()) - 1;
}

std::string spoken(const std::string& pointer) {
  std::string out = pointer;
  for (const std::string prefix : {"/scene/", "/methods/"})
    if (out.starts_with(prefix)) {
      out = out.substr(prefix.size());
      break;
    }
  std::replace(out.begin(), out.end(), '/', '.');
  return out;
}

std::string parameter_pointer(const StudyResults& results) {
  const auto parameter = results.study.find("parameter");
  return parameter != results.study.end() && parameter->is_object() ? parameter->value("pointer", "") : "";
}

void read_runs(Diagram& diagram, CaseRuns& owner) {
  const DerivedTable& table = *owner.table;
  const auto parameter = column_of(table, "parameter"), start = column_of(table, "start"),
             regime = column_of(table, "class"), period = column_of(table, "period"),
             symmetric = column_of(table, "symmetric"), viscosity = column_of(table, "alpha_equivalent"),
             status = column_of(table, "status");
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto value = number_of(cell_of(table, r, parameter));
    if (!value) continue;
    Run run;
    run.parameter = *value;
    run.row = r;
    run.start = index_in(diagram.starts, text_of(cell_of(table, r, start)));
    run.status = status ? text_of(cell_of(table, r, status)) : "done";
    const auto repeats = number_of(cell_of(table, r, period));
    run.motion = motion_of(text_of(cell_of(table, r, regime)), repeats, run.status);
    owner.any_decided = owner.any_decided || run.decided();
    if (repeats && *repeats >= 1) run.period = static_cast<int>(*repeats);
    if (const Json cell = cell_of(table, r, symmetric); cell.is_boolean()) run.symmetric = cell.get<bool>();
    run.viscosity = number_of(cell_of(table, r, viscosity));
    owner.runs.push_back(std::move(run));
  }
}

void number_values(Diagram& diagram) {
  std::set<double> values;
  for (const CaseRuns& owner : diagram.cases)
    for (const Run& run : owner.runs) values.insert(run.parameter);
  diagram.values.assign(values.begin(), values.end());
  for (CaseRuns& owner : diagram.cases) {
    owner.at.assign(diagram.values.size() * diagram.starts.size(), -1);
    for (std::size_t k = 0; k < owner.runs.size(); ++k) {
      Run& run = owner.runs[k];
      run.value = static_cast<int>(std::lower_bound(diagram.values.begin(), diagram.values.end(), run.parameter) -
                                   diagram.values.begin());
      owner.at[static_cast<std::size_t>(run.value) * diagram.starts.size() + static_cast<std::size_t>(run.start)] =
          static_cast<int>(k);
    }
  }
}

/// Of the contact law of a case. Stores of earlier versions do not hold it: there the axis tells that the penalties of
/// this tree have, and a case without one is taken for rigid.
std::optional<double> compliance_of(const CaseRecord& record) {
  for (const NumberTable& table : record.numbers)
    if (table.name == "contact_law" && table.rows() == 1) {
      const double told = table.columns.front().front();
      return std::isfinite(told) ? std::optional(told) : std::nullopt;
    }
  const auto stiffness = number_of(axis_of(record, "contact.stiffness"));
  return stiffness ? 1 / *stiffness : 0;
}

CloudPoint scale_of(const Diagram& diagram) {
  ScaleOfPoints scale;
  for (const CaseRuns& owner : diagram.cases) {
    const auto *x = owner.sections.column("tip_displacement"), *v = owner.sections.column("tip_velocity");
    if (!x || !v) continue;
    for (std::size_t k = 0; k < x->size(); ++k) scale.add({(*x)[k], (*v)[k]});
    const auto *later_x = owner.sections.column("opposite_displacement"),
               *later_v = owner.sections.column("opposite_velocity");
    if (!later_x || !later_v) continue;
    for (std::size_t k = 0; k < later_x->size(); ++k) scale.add({-(*later_x)[k], -(*later_v)[k]});
  }
  return scale.scale();
}

/// Points per cycle of a run; 0: it is no cycle.
int cycle_of(const Run& run) {
  if (run.motion.regime == Regime::periodic) return run.motion.period;
  return run.motion.regime == Regime::no_contact ? std::max(run.period, 1) : 0;
}

}  // namespace

SectionIndex::SectionIndex(const CaseRecord& record, const std::string& table, const std::string& key,
                           const std::string& word) {
  for (const NumberTable& one : record.numbers)
    if (one.name == table) table_ = &one;
  const std::vector<double>*keys = column(key), *second = word.empty() ? nullptr : column(word);
  if (!keys || (!word.empty() && !second)) return;
  const std::vector<std::string>* words = nullptr;
  for (const auto& [name, list] : table_->words)
    if (name == word) words = &list;
  std::size_t first = 0;
  for (std::size_t k = 0; k <= keys->size(); ++k) {
    const bool same = k < keys->size() && (*keys)[k] == (*keys)[first] && (!second || (*second)[k] == (*second)[first]);
    if (same) continue;
    if (k > first) {
      std::string name;
      if (second && words) {
        const double index = (*second)[first];
        if (index >= 0 && index < static_cast<double>(words->size())) name = (*words)[static_cast<std::size_t>(index)];
      }
      ranges_[{(*keys)[first], name}].emplace_back(first, k);
    }
    first = k;
  }
}

const std::vector<double>* SectionIndex::column(const std::string& name) const {
  if (!table_) return nullptr;
  for (std::size_t c = 0; c < table_->names.size(); ++c)
    if (table_->names[c] == name) return &table_->columns[c];
  return nullptr;
}

SectionReadings SectionIndex::read(double key, const std::string& word) const {
  SectionReadings out;
  const auto found = ranges_.find({key, word});
  const std::vector<double>*x = column("tip_displacement"), *v = column("tip_velocity");
  if (found == ranges_.end() || !x || !v) return out;
  const std::vector<double>*ox = column("opposite_displacement"), *ov = column("opposite_velocity");
  bool whole = ox && ov;
  for (const auto& [first, last] : found->second)
    for (std::size_t k = first; k < last; ++k) {
      if (!std::isfinite((*x)[k]) || !std::isfinite((*v)[k])) continue;
      out.points.push_back({(*x)[k], (*v)[k]});
      whole = whole && std::isfinite((*ox)[k]) && std::isfinite((*ov)[k]);
      if (whole) out.opposite.push_back({(*ox)[k], (*ov)[k]});
    }
  if (!whole) out.opposite.clear();
  return out;
}

const Run* Diagram::run(std::size_t case_index, int value, int start) const {
  const CaseRuns& owner = cases[case_index];
  const int k = owner.at[static_cast<std::size_t>(value) * starts.size() + static_cast<std::size_t>(start)];
  return k < 0 ? nullptr : &owner.runs[static_cast<std::size_t>(k)];
}

Diagram read_diagram(const StudyResults& results) {
  Diagram diagram;
  diagram.results = &results;
  diagram.parameter = spoken(parameter_pointer(results));
  const auto section = results.study.find("section");
  diagram.strobed = section == results.study.end() || !section->is_string() || *section == "strobe";
  std::vector<const CaseRecord*> records;
  for (const CaseRecord& record : results.cases) {
    const DerivedTable* table = table_of(record, "values");
    if (!table) continue;
    diagram.cases.push_back({&record, table, SectionIndex(record, "points", "parameter", "start"), {}, {}});
    records.push_back(&record);
    diagram.cases.back().compliance = compliance_of(record);
    read_runs(diagram, diagram.cases.back());
  }
  number_values(diagram);
  diagram.scale = scale_of(diagram);
  diagram.axes = axes_of(results, records);
  return diagram;
}

SettledSection settled_section(const Diagram& diagram, const CaseRuns& owner, const Run& run) {
  const SectionReadings readings =
      owner.sections.read(run.parameter, diagram.starts[static_cast<std::size_t>(run.start)]);
  const int cycle = cycle_of(run);
  SettledSection out{run.motion, cycle > 0, {}};
  if (cycle == 0 || diagram.strobed) {
    out.cloud = make_cloud(readings.points, readings.opposite, diagram.scale, cycle);
    return out;
  }
  // Impacts or extrema: how many there are in a cycle is seen from the points themselves.
  const auto half = [&](const std::vector<CloudPoint>& points) {
    std::vector<CloudPoint> last;
    for (std::size_t k = points.size() / 2; k < points.size(); ++k)
      last.push_back({points[k][0] / diagram.scale[0], points[k][1] / diagram.scale[1]});
    return distinct_points(last, kSamePoint);
  };
  out.cloud.points = half(readings.points);
  out.cloud.opposite = half(readings.opposite);
  if (out.cloud.points.size() > kLargestCycle || out.cloud.opposite.size() > kLargestCycle)
    out.cloud = make_cloud(readings.points, readings.opposite, diagram.scale, 0);
  return out;
}

HalvesNull null_of(const Diagram& diagram, const CaseRuns& owner, const Run& run) {
  const SectionReadings readings =
      owner.sections.read(run.parameter, diagram.starts[static_cast<std::size_t>(run.start)]);
  return null_of_halves(readings.points, diagram.scale, diagram.strobed ? cycle_of(run) : 0);
}

std::optional<std::size_t> reference_case(const Diagram& diagram) {
  std::optional<std::size_t> best;
  std::tuple<double, double, double> best_rank;
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    if (!diagram.cases[c].any_decided) continue;
    const CaseRecord& record = *diagram.cases[c].record;
    const double compliance = diagram.cases[c].compliance.value_or(INFINITY);
    const std::tuple rank(-compliance, number_of(axis_of(record, "steps_per_period")).value_or(0),
                          number_of(axis_of(record, "elements")).value_or(0));
    if (!best || rank > best_rank) {
      best = c;
      best_rank = rank;
    }
  }
  return best;
}

std::optional<double> viscosity_of(const Diagram& diagram, const CaseRuns& owner, const Run& run) {
  const std::string path = "structure.damping.stiffness";
  if (diagram.parameter == path) return run.parameter;
  if (const auto value = number_of(axis_of(*owner.record, path))) return value;
  const Json::json_pointer pointer("/scene/structure/damping/stiffness");
  const Json& study = diagram.results->study;
  return study.contains(pointer) ? number_of(study.at(pointer)) : std::nullopt;
}

MotionClass motion_of(const std::string& regime, std::optional<double> period, const std::string& status) {
  if (status != "done") return {Regime::failed};
  return motion_class(regime, period).value_or(MotionClass{});
}

const DerivedTable* table_of(const CaseRecord& record, const std::string& name) {
  for (const DerivedTable& table : record.tables)
    if (table.name == name) return &table;
  return nullptr;
}

std::optional<std::size_t> column_of(const DerivedTable& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.columns.begin());
}

Json cell_of(const DerivedTable& table, std::size_t row, std::optional<std::size_t> column) {
  return column && *column < table.rows[row].size() ? table.rows[row][*column] : Json(nullptr);
}

std::optional<double> number_of(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

Json number_cell(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json axis_of(const CaseRecord& record, const std::string& column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return value;
  return nullptr;
}

DerivedTable table_with_axes(const StudyResults& results, const std::string& name, std::vector<std::string> columns) {
  DerivedTable table{name, {"case"}, {}};
  table.columns.insert(table.columns.end(), results.columns.begin(), results.columns.end());
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  return table;
}

Row axes_row(const StudyResults& results, const CaseRecord& record) {
  Row row = {record.id};
  for (const std::string& column : results.columns) row.push_back(axis_of(record, column));
  return row;
}

std::vector<ChoiceAxis> axes_of(const StudyResults& results, const std::vector<const CaseRecord*>& cases) {
  std::vector<ChoiceAxis> axes;
  for (const std::string& column : results.columns) {
    ChoiceAxis axis{column, {}};
    for (const CaseRecord* record : cases) axis.levels.push_back(axis_text(axis_of(*record, column)));
    axes.push_back(std::move(axis));
  }
  return axes;
}

}  // namespace ricochet::dynamics
