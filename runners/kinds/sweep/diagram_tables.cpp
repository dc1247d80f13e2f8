#include "runners/kinds/sweep/diagram_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ricochet/measure/attractors/diagram.hpp>

#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/rows_of_cases.hpp"

namespace ricochet {
namespace {

using namespace dynamics;

Table values_table(const StudyDiagram& study) {
  const StudyResults& results = *study.results;
  const Table head = values_head(0, study.swept);
  Table table = table_of_cases(results, head.name, head.text, {});
  for (std::size_t c = 0; c < study.sources.size(); ++c) {
    const DiagramSource& source = study.sources[c];
    const std::size_t first = table.rows.size();
    append_rows(results, *source.record, *source.table, table);
    const auto column = find_column(table.columns, attractor_column.name);
    if (!column) continue;
    const std::vector<DiagramRun>& runs = study.diagram.cases[c].runs;
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (runs[k].attractor > 0) table.rows[first + source.rows[k]][*column] = runs[k].attractor;
  }
  return table;
}

Table bifurcations_table(const StudyDiagram& study) {
  const Table head = bifurcations_head(study.swept);
  Table table = table_of_cases(*study.results, head.name, head.text, {});
  for (const DiagramSource& source : study.sources)
    if (const Table* own = find_table(source.record->tables, head.name))
      append_rows(*study.results, *source.record, *own, table);
  return table;
}

}  // namespace

bool derived_as_dynamics(const std::string& table) {
  return table == "values" || table == "bifurcations" || table == "cells";
}

SweptMotions derive_dynamics(StudyResults& results) {
  StudyDiagram study = read_diagram(results);
  if (study.sources.empty()) return {};
  Table distances = find_attractors(study);
  std::vector<Table> tables = {values_table(study),  bifurcations_table(study), attractors_table(study),
                               std::move(distances), verdicts_table(study),     agreement_table(study),
                               shifts_table(study)};
  tables.push_back(verdict_shares_table(*find_table(tables, "intervals"), study.swept));
  for (Table table :
       {class_counts_table(study), grazing_ranges_table(results, study.swept), numerical_viscosity_table(study)})
    tables.push_back(std::move(table));
  for (Table& table : tables) results.derived.push_back(std::move(table));
  SweptMotions out;
  for (std::size_t c = 0; c < study.sources.size(); ++c) out.records.push_back(&study.record(c));
  out.diagram = std::move(study.diagram);
  return out;
}

}  // namespace ricochet

namespace ricochet::dynamics {
namespace {

/// A change moves by less than this share of the values' range; further away there is another one.
constexpr double kReach = 0.1;

/// Whether a class is none: what comes before or after it is no change of the motion.
bool open(const std::string& regime) {
  return regime == word(Regime::undecided) || regime == word(Regime::failed);
}

// Those between classes that are known.
std::vector<DiagramChange> known_changes(const CaseRecord& record) {
  std::vector<DiagramChange> out;
  for (DiagramChange change : changes_of(record)) {
    if (std::isnan(change.value) || open(change.from) || open(change.to)) continue;
    if (std::isnan(change.low)) change.low = change.value;
    if (std::isnan(change.high)) change.high = change.value;
    out.push_back(std::move(change));
  }
  return out;
}

}  // namespace

Table agreement_table(const StudyDiagram& study) {
  std::vector<AgreementRow> rows;
  const std::vector<DiagramCase>& cases = study.diagram.cases;
  for (std::size_t a = 0; cases.size() > 1 && a < cases.size(); ++a)
    for (std::size_t b = 0; b < cases.size(); ++b) {
      const auto [compared, same_class, same_attractor] = agreement(cases[a], cases[b]);
      const auto share = [all = compared](int count) {
        return all > 0 ? std::optional(static_cast<double>(count) / all) : std::nullopt;
      };
      rows.push_back({study.record(a).id, study.record(b).id, compared, same_class, share(same_class), same_attractor,
                      share(same_attractor)});
    }
  return agreement_type().with(rows);
}

Table shifts_table(const StudyDiagram& study) {
  const Diagram& diagram = study.diagram;
  std::vector<ShiftRow> rows;
  const auto table = [&] { return rows_of_cases(*study.results, shifts_type(study.swept), rows); };
  const auto reference = reference_case(diagram);
  if (!reference) return table();
  const CaseRecord& standard = study.record(*reference);
  const std::vector<DiagramChange> expected = known_changes(standard);
  const double reach = kReach * (diagram.values.back() - diagram.values.front());
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    if (c == *reference || !diagram.cases[c].any_decided()) continue;
    const std::vector<DiagramChange> here = known_changes(study.record(c));
    const std::vector<int> match = match_changes(expected, here, reach);
    std::vector<char> used(here.size(), 0);
    const auto add = [&](const DiagramChange& change, const DiagramChange* standing, const DiagramChange* found) {
      const bool both = standing && found;
      ShiftRow row{study.record(c).id, standard.id, change.start, change.from, change.to, change.kind};
      if (standing) row.reference_value = standing->value;
      if (found) row.value = found->value;
      if (both) {
        row.shift = found->value - standing->value;
        row.low = found->low - standing->high;
        row.high = found->high - standing->low;
      }
      row.found = both;
      rows.push_back(std::move(row));
    };
    for (std::size_t k = 0; k < expected.size(); ++k) {
      if (match[k] >= 0) used[static_cast<std::size_t>(match[k])] = 1;
      add(expected[k], &expected[k], match[k] < 0 ? nullptr : &here[static_cast<std::size_t>(match[k])]);
    }
    for (std::size_t k = 0; k < here.size(); ++k)
      if (!used[k]) add(here[k], nullptr, &here[k]);
  }
  return table();
}

namespace {

constexpr double kNothing = 1e-12;

void add_distances(const StudyDiagram& study, const ValueSections& sections, int value, std::size_t reference,
                   std::vector<DistanceRow>& rows) {
  const Diagram& diagram = study.diagram;
  for (int s = 0; s < diagram.start_count(); ++s) {
    const DiagramRun* one = diagram.run(reference, value, s);
    if (!one) continue;
    const auto of_reference = sections.find({reference, s});
    HalvesNull null;
    if (of_reference != sections.end()) null = null_of(study, reference, *one);
    for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
      const DiagramRun* other = diagram.run(c, value, s);
      if (c == reference || !other) continue;
      DistanceRow row{study.record(c).id, study.record(reference).id, one->parameter,
                      diagram.starts[static_cast<std::size_t>(s)].name};
      const auto of_other = sections.find({c, s});
      if (one->decided() && other->decided()) row.same_class = one->motion == other->motion;
      if (of_reference != sections.end() && of_other != sections.end() && !of_reference->second.cloud.empty() &&
          !of_other->second.cloud.empty()) {
        const SectionCloud &a = of_reference->second.cloud, &b = of_other->second.cloud;
        row.wasserstein = cloud_distance(a, b);
        row.hausdorff = cloud_hausdorff(a, b);
        row.null_wasserstein = null.wasserstein;
        row.null_hausdorff = null.hausdorff;
        if (null.wasserstein > kNothing) row.ratio = *row.wasserstein / null.wasserstein;
        row.formula = compared_exactly(a, b) ? "exact" : "sliced";
      }
      rows.push_back(std::move(row));
    }
  }
}

std::optional<bool> symmetric(const AttractorExtent& extent) {
  if (extent.symmetric > 0 && extent.asymmetric == 0) return true;
  if (extent.asymmetric > 0 && extent.symmetric == 0) return false;
  return std::nullopt;
}

}  // namespace

Table find_attractors(StudyDiagram& study) {
  std::vector<DistanceRow> distances;
  const auto reference = reference_case(study.diagram);
  ricochet::find_attractors(
      study.diagram, [&](std::size_t c, const DiagramRun& run) { return settled_section(study, c, run); },
      [&](int value, const ValueSections& sections) {
        if (reference) add_distances(study, sections, value, *reference, distances);
      });
  return rows_of_cases(*study.results, distances_type(study.swept), distances);
}

Table attractors_table(const StudyDiagram& study) {
  const Diagram& diagram = study.diagram;
  std::vector<AttractorRow> rows;
  const std::vector<AttractorExtent> extents = extents_of(diagram);
  for (std::size_t k = 0; k < extents.size(); ++k) {
    const AttractorExtent& extent = extents[k];
    if (extent.first < 0) continue;
    const int attractor = static_cast<int>(k) + 1;
    const double from = diagram.values[static_cast<std::size_t>(extent.first)],
                 to = diagram.values[static_cast<std::size_t>(extent.last)];
    const PresenceLabel label = label_presence(presence_of(diagram, extent, attractor), study.axes);
    const Proportion fraction = fraction_of(diagram, extent, attractor);
    const std::string range =
        extent.first == extent.last
            ? "at " + six_digits(from)
            : fmt::format("{} to {}, {}", six_digits(from), six_digits(to), count_of(extent.values.size(), "value"));
    rows.push_back({attractor, label.label, static_cast<int>(extent.cases.size()), from, to, word(extent.motion.regime),
                    period_of(extent.motion), symmetric(extent), fraction.value, fraction.low, fraction.high,
                    label.presence,
                    fmt::format("Attractor {} ({}, {}) {}", attractor, text(extent.motion), range, label.sentence)});
  }
  return attractors_type(study.swept).with(rows);
}

}  // namespace ricochet::dynamics
