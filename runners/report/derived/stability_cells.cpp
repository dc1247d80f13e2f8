#include <algorithm>

#include "runners/report/derived/shown_tables.hpp"
#include "runners/report/stability_rows.hpp"

namespace ricochet::report {
namespace {

std::string prediction_of(const StabilityCell& cell) {
  if (cell.predicted_unstable()) return "predicted unstable";
  if (!cell.worst) return "not predicted";
  return cell.marginal.empty() ? "predicted stable" : "predicted marginal";
}

/// Calls `use` with each contact state of each case that has one.
template <class Use>
void each_range(const CaseView& view, Use use) {
  for (const bool closed : {false, true})
    for (const CaseRecord* record : view.all())
      if (const auto range = stability_range(*record, closed)) use(*range);
}

}  // namespace

Table stability_cells(const CaseView& view) {
  Table out{"stability_cells",
            "One row per case, contact state and step: what was predicted there, and what was observed.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"closed", "", "Whether the contact is closed."},
             {"step", "s", "The step."},
             {"radius", "1", "Spectral radius of one step of this contact state."},
             {"growth", "1", "Spectral radius less one."},
             {"worst", "1", "Largest radius of the states that a marched scene meets: it is open as well."},
             {"prediction", "", "predicted stable, marginal or unstable; not predicted."},
             {"behaviour", "", "What marching showed; nothing where the cell was not marched."},
             {"unstable", "", "Whether it was observed to grow."},
             {"disagrees", "", "Whether prediction and observation differ."},
             {"marginal", "", "Roots on the unit circle, where there are any."},
             {"status", "", "stable, marginal, unstable, failed or refused."},
             {"reason", "", "Why, where it is not stable."}},
            {}};
  each_range(view, [&](const StabilityRange& range) {
    for (const StabilityCell& cell : range.cells) {
      const auto growth = cell.radius ? std::optional(*cell.radius - 1) : std::nullopt;
      out.rows.push_back({range.record->id, range.closed, cell.step, Cell(cell.radius), Cell(growth), Cell(cell.worst),
                          prediction_of(cell), cell.behaviour, cell.observed_unstable(), cell.disagrees(),
                          cell.marginal, cell.status, cell.reason});
    }
  });
  return out;
}

Table stability_limits(const CaseView& view) {
  Table out{
      "stability_limits",
      "One row per case and contact state: its step limits as they are drawn.",
      {{"case", "", "Identity of the case: its row in cases.csv."},
       {"closed", "", "Whether the contact is closed."},
       {"predicted", "s",
        "Largest stable step that the spectrum allows; nothing where there is no limit in the range."},
       {"observed", "s", "Largest step observed to be stable."},
       {"expected", "s", "The smaller of the predicted limits that a marched scene meets."},
       {"stands", "",
        "Whether the row stands for others that differ in the contact law alone: open ranges do not depend on it."}},
      {}};
  const Cases open = stability_cases(view, false);
  each_range(view, [&](const StabilityRange& range) {
    const bool stands = range.closed || std::find(open.begin(), open.end(), range.record) != open.end();
    out.rows.push_back(
        {range.record->id, range.closed, Cell(range.predicted), Cell(range.observed), Cell(range.expected), stands});
  });
  return out;
}

Table stability_disagreements(const CaseView& view) {
  Table out{"stability_disagreements",
            "One row per range of neighbouring steps at which prediction and observation differ in the same way.",
            {{"case", "", "Identity of the case: its row in cases.csv."},
             {"closed", "", "Whether the contact is closed."},
             {"from", "s", "Smallest step of the range."},
             {"to", "s", "Largest step of the range."},
             {"steps", "1", "Steps in the range."},
             {"predicted", "", "stable or unstable."},
             {"observed", "", "stable or unstable."}},
            {}};
  each_range(view, [&](const StabilityRange& range) {
    for (const Disagreement& one : disagreements(range))
      out.rows.push_back({range.record->id, range.closed, one.from, one.to, one.steps,
                          one.predicted_unstable ? "unstable" : "stable",
                          one.predicted_unstable ? "stable" : "unstable"});
  });
  return out;
}

}  // namespace ricochet::report
