#include "runners/report/stability_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/report/html.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet::report {
std::optional<StabilityRange> stability_range(const CaseRecord& record, bool closed) {
  const Table* predicted = find_table(record.tables, "stability");
  if (!predicted) return std::nullopt;
  StabilityRange out;
  out.record = &record;
  out.closed = closed;
  std::map<double, std::string> behaviours;
  if (const Table* observed = find_table(record.tables, "stability_observed")) {
    const TableReader rows(*observed);
    const size_t step = rows.column("step"), state = rows.column("closed"), behaviour = rows.column("behaviour");
    for (size_t row = 0; row < rows.size(); ++row)
      if (const auto h = rows.number(row, step); h && rows.truth(row, state) == closed)
        behaviours[*h] = rows.text(row, behaviour);
  }
  const TableReader rows(*predicted);
  const size_t step = rows.column("step"), state = rows.column("closed"), radius = rows.column("radius"),
               marginal = rows.column("marginal"), status = rows.column("status"), reason = rows.column("reason"),
               limit_predicted = rows.column("limit_predicted"), limit_observed = rows.column("limit_observed");
  for (size_t row = 0; row < rows.size(); ++row) {
    const auto h = rows.number(row, step);
    if (rows.truth(row, state) != closed || !h) continue;
    StabilityCell one;
    one.step = *h;
    one.radius = rows.number(row, radius);
    one.marginal = rows.text(row, marginal);
    one.status = rows.text(row, status);
    one.reason = rows.text(row, reason);
    if (const auto seen = behaviours.find(*h); seen != behaviours.end()) one.behaviour = seen->second;
    out.predicted = rows.number(row, limit_predicted);
    out.observed = rows.number(row, limit_observed);
    out.cells.push_back(std::move(one));
  }
  if (out.cells.empty()) return std::nullopt;
  out.expected = out.predicted;
  for (StabilityCell& one : out.cells) one.worst = one.radius;
  if (closed)
    if (const auto open = stability_range(record, false)) {
      if (open->predicted) out.expected = std::min(*open->predicted, out.predicted.value_or(*open->predicted));
      for (StabilityCell& one : out.cells)
        for (const StabilityCell& apart : open->cells)
          if (apart.step == one.step && apart.radius && one.radius) one.worst = std::max(*one.radius, *apart.radius);
    }
  std::sort(out.cells.begin(), out.cells.end(),
            [](const StabilityCell& a, const StabilityCell& b) { return a.step < b.step; });
  return out;
}

std::vector<std::string> contact_columns(const CaseView& view) {
  std::vector<std::string> out;
  for (const std::string& column : view.varying())
    if (role_of(column) == "contact") out.push_back(column);
  return out;
}

Cases stability_cases(const CaseView& view, bool closed) {
  Cases with;
  for (const CaseRecord* record : view.all())
    if (stability_range(*record, closed)) with.push_back(record);
  if (closed) return with;
  Cases out;
  for (const CaseGroup& same : view.group(with, view.varying_without({"contact"}))) {
    const auto done = std::find_if(same.cases.begin(), same.cases.end(),
                                   [](const CaseRecord* record) { return record->status == "done"; });
    out.push_back(done == same.cases.end() ? same.cases.front() : *done);
  }
  return out;
}

std::vector<Disagreement> disagreements(const StabilityRange& range) {
  std::vector<Disagreement> out;
  const std::vector<StabilityCell>& cells = range.cells;
  for (size_t i = 0; i < cells.size();) {
    if (!cells[i].disagrees()) {
      ++i;
      continue;
    }
    size_t end = i;
    const bool predicted = cells[i].predicted_unstable();
    while (end < cells.size() && cells[end].disagrees() && cells[end].predicted_unstable() == predicted) ++end;
    out.push_back({cells[i].step, cells[end - 1].step, end - i, predicted});
    i = end;
  }
  return out;
}

}  // namespace ricochet::report
