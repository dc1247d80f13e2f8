#include <algorithm>

#include "runners/report/derived/shown_tables.hpp"
#include "runners/report/stability_rows.hpp"

namespace ricochet::report {
namespace {

using CellJson = nlohmann::ordered_json;

CellJson cell_of(const std::optional<double>& value) {
  return value ? CellJson(*value) : CellJson(nullptr);
}

std::string prediction_of(const StabilityCell& cell) {
  if (cell.predicted_unstable()) return "predicted unstable";
  if (!cell.worst) return "not predicted";
  return cell.marginal.empty() ? "predicted stable" : "predicted marginal";
}

/// Calls `use` with each contact state of each case that has one, and its name.
template <class Use>
void each_range(const CaseView& view, Use use) {
  for (const bool closed : {false, true})
    for (const CaseRecord* record : view.all())
      if (const auto range = stability_range(*record, closed)) use(*range, closed ? "closed" : "open");
}

}  // namespace

DerivedTable stability_cells(const CaseView& view) {
  DerivedTable out{"stability_cells",
                   {"case", "contact", "step", "radius", "growth", "worst", "prediction", "behaviour", "unstable",
                    "disagrees", "marginal", "status", "reason"},
                   {}};
  each_range(view, [&](const StabilityRange& range, const char* contact) {
    for (const StabilityCell& cell : range.cells) {
      const auto growth = cell.radius ? std::optional(*cell.radius - 1) : std::nullopt;
      out.rows.push_back({range.record->id, contact, cell.step, cell_of(cell.radius), cell_of(growth),
                          cell_of(cell.worst), prediction_of(cell), cell.behaviour, cell.observed_unstable(),
                          cell.disagrees(), cell.marginal, cell.status, cell.reason});
    }
  });
  return out;
}

DerivedTable stability_limits(const CaseView& view) {
  DerivedTable out{"stability_limits", {"case", "contact", "predicted", "observed", "expected", "stands"}, {}};
  const Cases open = stability_cases(view, false);
  each_range(view, [&](const StabilityRange& range, const char* contact) {
    const bool stands = range.closed || std::find(open.begin(), open.end(), range.record) != open.end();
    out.rows.push_back({range.record->id, contact, cell_of(range.predicted), cell_of(range.observed),
                        cell_of(range.expected), stands});
  });
  return out;
}

DerivedTable stability_disagreements(const CaseView& view) {
  DerivedTable out{"stability_disagreements", {"case", "contact", "from", "to", "steps", "predicted", "observed"}, {}};
  each_range(view, [&](const StabilityRange& range, const char* contact) {
    for (const Disagreement& one : disagreements(range))
      out.rows.push_back({range.record->id, contact, one.from, one.to, one.steps,
                          one.predicted_unstable ? "unstable" : "stable",
                          one.predicted_unstable ? "stable" : "unstable"});
  });
  return out;
}

}  // namespace ricochet::report
