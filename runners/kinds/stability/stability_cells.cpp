#include "runners/kinds/stability/step_limits.hpp"
#include "runners/kinds/stability/step_range.hpp"

namespace ricochet {
namespace {

std::string prediction_at(const StepCell& cell) {
  if (cell.predicted_unstable()) return "predicted unstable";
  if (!cell.worst) return "not predicted";
  return cell.marginal.empty() ? "predicted stable" : "predicted marginal";
}

// Calls `use` with each contact state of each case that has one.
template <class Use>
void each_range(const StudyResults& results, Use use) {
  for (const bool closed : {false, true})
    for (const CaseRecord& record : results.cases)
      if (const auto range = step_range(record, closed)) use(record, closed, *range);
}

const std::vector<Column> range_columns = {{"case", "", "Identity of the case: its row in cases.csv."},
                                           {"closed", "", "Whether the contact is closed."}};

Table table_of_ranges(std::string name, std::string text, const std::vector<Column>& columns) {
  Table out{std::move(name), std::move(text), range_columns, {}};
  out.columns.insert(out.columns.end(), columns.begin(), columns.end());
  return out;
}

}  // namespace

Table stability_cells_table(const StudyResults& results) {
  Table out = table_of_ranges(
      "stability_cells", "One row per case, contact state and step: what was predicted there, and what was observed.",
      {{"step", "s", "The step."},
       {"radius", "1", "Spectral radius of one step of this contact state."},
       {"growth", "1", "Spectral radius less one."},
       {"worst", "1", "Largest radius of the states that a marched scene meets: it is open as well."},
       {"prediction", "", "predicted stable, marginal or unstable; not predicted."},
       {"behaviour", "", "What marching showed; nothing where the cell was not marched."},
       {"unstable", "", "Whether it was observed to grow."},
       {"disagrees", "", "Whether prediction and observation differ."},
       {"marginal", "", "Roots on the unit circle, where there are any."},
       {"status", "", "stable, marginal, unstable, failed or refused."},
       {"reason", "", "Why, where it is not stable."}});
  each_range(results, [&](const CaseRecord& record, bool closed, const StepRange& range) {
    for (const StepCell& cell : range.cells) {
      const auto growth = cell.radius ? std::optional(*cell.radius - 1) : std::nullopt;
      out.rows.push_back({record.id, closed, cell.step, Cell(cell.radius), Cell(growth), Cell(cell.worst),
                          prediction_at(cell), cell.behaviour, cell.observed_unstable(), cell.disagrees(),
                          cell.marginal, cell.status, cell.reason});
    }
  });
  return out;
}

Table stability_disagreements_table(const StudyResults& results) {
  Table out = table_of_ranges(
      "stability_disagreements",
      "One row per range of neighbouring steps at which prediction and observation differ in the same way.",
      {{"from", "s", "Smallest step of the range."},
       {"to", "s", "Largest step of the range."},
       {"steps", "1", "Steps in the range."},
       {"predicted", "", "stable or unstable."},
       {"observed", "", "stable or unstable."}});
  const auto word = [](bool unstable) { return unstable ? "unstable" : "stable"; };
  each_range(results, [&](const CaseRecord& record, bool closed, const StepRange& range) {
    for (const Disagreement& one : disagreements(range))
      out.rows.push_back({record.id, closed, one.from, one.to, one.steps, word(one.predicted_unstable),
                          word(!one.predicted_unstable)});
  });
  return out;
}

}  // namespace ricochet
