#include <cmath>
#include <ricochet/measure/attractors/diagram_attractors.hpp>

#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::dynamics {
namespace {

/// A change moves by less than this share of the values' range; further away there is another one.
constexpr double kReach = 0.1;

/// Whether a class is none: what comes before or after it is no change of the motion.
bool open(const std::string& regime) {
  return regime == text(Regime::undecided) || regime == text(Regime::failed);
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
  Table table = agreement_head();
  const std::vector<DiagramCase>& cases = study.diagram.cases;
  if (cases.size() < 2) return table;
  for (std::size_t a = 0; a < cases.size(); ++a)
    for (std::size_t b = 0; b < cases.size(); ++b) {
      const auto [compared, same_class, same_attractor] = agreement(cases[a], cases[b]);
      const auto share = [all = compared](int count) {
        return all > 0 ? Cell(static_cast<double>(count) / all) : Cell();
      };
      table.rows.push_back({study.record(a).id, study.record(b).id, compared, same_class, share(same_class),
                            same_attractor, share(same_attractor)});
    }
  return table;
}

Table shifts_table(const StudyDiagram& study) {
  const Diagram& diagram = study.diagram;
  Table table = table_of_cases(*study.results, shifts_head(study.swept));
  const auto reference = reference_case(diagram);
  if (!reference) return table;
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
      add_row(
          table, place_of(*study.results, study.record(c)),
          {standard.id, change.start, change.from, change.to, change.kind, standing ? Cell(standing->value) : Cell(),
           found ? Cell(found->value) : Cell(), both ? Cell(found->value - standing->value) : Cell(),
           both ? Cell(found->low - standing->high) : Cell(), both ? Cell(found->high - standing->low) : Cell(), both});
    };
    for (std::size_t k = 0; k < expected.size(); ++k) {
      if (match[k] >= 0) used[static_cast<std::size_t>(match[k])] = 1;
      add(expected[k], &expected[k], match[k] < 0 ? nullptr : &here[static_cast<std::size_t>(match[k])]);
    }
    for (std::size_t k = 0; k < here.size(); ++k)
      if (!used[k]) add(here[k], nullptr, &here[k]);
  }
  return table;
}

}  // namespace ricochet::dynamics
