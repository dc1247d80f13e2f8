#include "runners/kinds/stability/step_range.hpp"

#include <algorithm>
#include <map>
#include <ricochet/measure/stability/stability.hpp>

#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

std::map<double, std::string> behaviours_of(const CaseRecord& record, bool closed) {
  std::map<double, std::string> out;
  const Table* observed = find_table(record.tables, "stability_observed");
  if (!observed) return out;
  const TableReader rows(*observed);
  const std::size_t step = rows.column("step"), state = rows.column("closed"), behaviour = rows.column("behaviour");
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (const auto h = rows.number(row, step); h && rows.truth(row, state) == closed)
      out[*h] = rows.text(row, behaviour);
  return out;
}

// The range as the case left it; nothing where it has none.
std::optional<StepRange> own_range(const CaseRecord& record, bool closed) {
  const Table* table = find_table(record.tables, "stability");
  if (!table) return std::nullopt;
  const TableReader rows(*table);
  const std::size_t step = rows.column("step"), state = rows.column("closed"), radius = rows.column("radius"),
                    marginal = rows.column("marginal"), status = rows.column("status"), reason = rows.column("reason"),
                    predicted = rows.column("limit_predicted"), observed = rows.column("limit_observed");
  const std::map<double, std::string> behaviours = behaviours_of(record, closed);
  StepRange out;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto h = rows.number(row, step);
    if (rows.truth(row, state) != closed || !h) continue;
    const auto seen = behaviours.find(*h);
    out.cells.push_back({*h, rows.number(row, radius), rows.number(row, radius), rows.text(row, marginal),
                         rows.text(row, status), rows.text(row, reason),
                         seen == behaviours.end() ? std::string() : seen->second});
    out.predicted = rows.number(row, predicted);
    out.observed = rows.number(row, observed);
  }
  if (out.cells.empty()) return std::nullopt;
  out.expected = out.predicted;
  std::stable_sort(out.cells.begin(), out.cells.end(),
                   [](const StepCell& a, const StepCell& b) { return a.step < b.step; });
  return out;
}

}  // namespace

std::optional<StepRange> step_range(const CaseRecord& record, bool closed) {
  std::optional<StepRange> out = own_range(record, closed);
  const std::optional<StepRange> open = out && closed ? own_range(record, false) : std::nullopt;
  if (!open) return out;
  if (open->predicted) out->expected = std::min(*open->predicted, out->predicted.value_or(*open->predicted));
  for (StepCell& one : out->cells) {
    const auto apart = std::lower_bound(open->cells.begin(), open->cells.end(), one.step,
                                        [](const StepCell& cell, double step) { return cell.step < step; });
    if (apart != open->cells.end() && apart->step == one.step && apart->radius && one.radius)
      one.worst = std::max(*one.radius, *apart->radius);
  }
  return out;
}

bool StepCell::predicted_unstable() const {
  return worst && *worst > 1 + growth_tolerance;
}

std::vector<Disagreement> disagreements(const StepRange& range) {
  std::vector<Disagreement> out;
  const std::vector<StepCell>& cells = range.cells;
  for (std::size_t i = 0; i < cells.size();) {
    if (!cells[i].disagrees()) {
      ++i;
      continue;
    }
    std::size_t end = i;
    const bool predicted = cells[i].predicted_unstable();
    while (end < cells.size() && cells[end].disagrees() && cells[end].predicted_unstable() == predicted) ++end;
    out.push_back({cells[i].step, cells[end - 1].step, end - i, predicted});
    i = end;
  }
  return out;
}

}  // namespace ricochet
