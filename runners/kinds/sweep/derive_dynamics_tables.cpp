#include <ricochet/measure/attractors/diagram_changes.hpp>

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"

namespace ricochet::dynamics {
namespace {

/// A change moves by less than this share of the values' range; further away there is another one.
constexpr double kReach = 0.1;

/// Whether a class is none: what comes before or after it is no change of the motion.
bool open(const std::string& regime) {
  return regime == text(Regime::undecided) || regime == text(Regime::failed);
}

std::vector<DiagramChange> changes_of(const CaseRecord& record) {
  std::vector<DiagramChange> out;
  const DerivedTable* table = table_of(record, "bifurcations");
  if (!table) return out;
  const auto word = [&](std::size_t row, const std::string& column) {
    const Json cell = cell_of(*table, row, column_of(*table, column));
    return cell.is_string() ? cell.get<std::string>() : std::string();
  };
  const auto number = [&](std::size_t row, const std::string& column) {
    return number_of(cell_of(*table, row, column_of(*table, column)));
  };
  for (std::size_t r = 0; r < table->rows.size(); ++r) {
    const auto value = number(r, "value");
    if (!value || open(word(r, "from")) || open(word(r, "to"))) continue;
    out.push_back({word(r, "start"), word(r, "from"), word(r, "to"), word(r, "kind"), *value,
                   number(r, "low").value_or(*value), number(r, "high").value_or(*value)});
  }
  return out;
}

}  // namespace

DerivedTable agreement_table(const StudyDiagram& study) {
  DerivedTable table{
      "agreement", {"case", "other_case", "compared", "same_class", "share", "same_attractor", "share_attractor"}, {}};
  const std::vector<DiagramCase>& cases = study.diagram.cases;
  if (cases.size() < 2) return table;
  for (std::size_t a = 0; a < cases.size(); ++a)
    for (std::size_t b = 0; b < cases.size(); ++b) {
      const auto [compared, same_class, same_attractor] = agreement(cases[a], cases[b]);
      const auto share = [all = compared](int count) {
        return all > 0 ? Json(static_cast<double>(count) / all) : Json(nullptr);
      };
      table.rows.push_back({study.record(a).id, study.record(b).id, compared, same_class, share(same_class),
                            same_attractor, share(same_attractor)});
    }
  return table;
}

DerivedTable shifts_table(const StudyDiagram& study) {
  const Diagram& diagram = study.diagram;
  DerivedTable table = table_with_axes(
      *study.results, "shifts",
      {"reference_case", "start", "from", "to", "kind", "reference_value", "value", "shift", "low", "high", "found"});
  const auto reference = reference_case(diagram);
  if (!reference) return table;
  const CaseRecord& standard = study.record(*reference);
  const std::vector<DiagramChange> expected = changes_of(standard);
  const double reach = kReach * (diagram.values.back() - diagram.values.front());
  for (std::size_t c = 0; c < diagram.cases.size(); ++c) {
    if (c == *reference || !diagram.cases[c].any_decided()) continue;
    const std::vector<DiagramChange> here = changes_of(study.record(c));
    const std::vector<int> match = match_changes(expected, here, reach);
    std::vector<char> used(here.size(), 0);
    const auto add = [&](const DiagramChange& change, const DiagramChange* standing, const DiagramChange* found) {
      Row row = axes_row(*study.results, study.record(c));
      row.insert(row.end(), {standard.id, change.start, change.from, change.to, change.kind});
      row.push_back(standing ? Json(standing->value) : Json(nullptr));
      row.push_back(found ? Json(found->value) : Json(nullptr));
      if (standing && found)
        row.insert(row.end(),
                   {found->value - standing->value, found->low - standing->high, found->high - standing->low, true});
      else
        row.insert(row.end(), {nullptr, nullptr, nullptr, false});
      table.rows.push_back(std::move(row));
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
