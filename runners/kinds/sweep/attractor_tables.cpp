#include <fmt/format.h>

#include <cmath>
#include <ricochet/measure/attractors/diagram_attractors.hpp>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::dynamics {
namespace {

constexpr double kNothing = 1e-12;

void add_distances(const StudyDiagram& study, const ValueSections& sections, int value, std::size_t reference,
                   Table& table) {
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
      Row row = {study.record(reference).id, one->parameter, diagram.starts[static_cast<std::size_t>(s)].name};
      const auto of_other = sections.find({c, s});
      const Cell same = one->decided() && other->decided() ? Cell(one->motion == other->motion) : Cell();
      if (of_reference == sections.end() || of_other == sections.end() || of_reference->second.cloud.empty() ||
          of_other->second.cloud.empty()) {
        row.insert(row.end(), {nullptr, nullptr, nullptr, nullptr, nullptr, same, ""});
      } else {
        const SectionCloud &a = of_reference->second.cloud, &b = of_other->second.cloud;
        const double distance = cloud_distance(a, b);
        const bool noisy = null.wasserstein > kNothing;
        row.insert(row.end(), {distance, cloud_hausdorff(a, b), null.wasserstein, null.hausdorff,
                               noisy ? Cell(distance / null.wasserstein) : Cell(), same,
                               compared_exactly(a, b) ? "exact" : "sliced"});
      }
      add_row(table, place_of(*study.results, study.record(c)), row);
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
  Table distances = table_of_cases(*study.results, distances_head(study.swept));
  const auto reference = reference_case(study.diagram);
  ricochet::find_attractors(
      study.diagram, [&](std::size_t c, const DiagramRun& run) { return settled_section(study, c, run); },
      [&](int value, const ValueSections& sections) {
        if (reference) add_distances(study, sections, value, *reference, distances);
      });
  return distances;
}

Table attractors_table(const StudyDiagram& study) {
  const Diagram& diagram = study.diagram;
  Table table = attractors_head(study.swept);
  const std::vector<AttractorExtent> extents = extents_of(diagram);
  for (std::size_t k = 0; k < extents.size(); ++k) {
    const AttractorExtent& extent = extents[k];
    if (extent.first < 0) continue;
    const int attractor = static_cast<int>(k) + 1;
    const bool periodic = extent.motion.period > 0;
    const double from = diagram.values[static_cast<std::size_t>(extent.first)],
                 to = diagram.values[static_cast<std::size_t>(extent.last)];
    const PresenceLabel label = label_presence(presence_of(diagram, extent, attractor), study.axes);
    const Proportion fraction = fraction_of(diagram, extent, attractor);
    const std::string range = extent.first == extent.last
                                  ? "at " + short_number(from)
                                  : fmt::format("{} to {}, {}", short_number(from), short_number(to),
                                                count_of(extent.values.size(), "value"));
    table.rows.push_back(
        {attractor, label.label, extent.cases.size(), from, to, text(extent.motion.regime),
         periodic ? Cell(extent.motion.period) : Cell(), symmetric(extent), fraction.value, fraction.low, fraction.high,
         label.presence,
         fmt::format("Attractor {} ({}, {}) {}", attractor, text(extent.motion), range, label.sentence)});
  }
  return table;
}

}  // namespace ricochet::dynamics
