#include "runners/report/stability_rows.hpp"

#include <algorithm>

namespace ricochet::report {
namespace {

using TableJson = nlohmann::ordered_json;

const DerivedTable* table_of(const CaseRecord& record, const std::string& name) {
  const auto found = std::find_if(record.tables.begin(), record.tables.end(),
                                  [&](const DerivedTable& table) { return table.name == name; });
  return found == record.tables.end() ? nullptr : &*found;
}

const TableJson& cell_in(const DerivedTable& table, const std::vector<TableJson>& row, const std::string& column) {
  static const TableJson none;
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  const auto index = static_cast<size_t>(found - table.columns.begin());
  return found == table.columns.end() || index >= row.size() ? none : row[index];
}

std::optional<double> number_in(const TableJson& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}
std::string text_in(const TableJson& value) {
  return value.is_string() ? value.get<std::string>() : "";
}

}  // namespace

std::optional<StabilityRange> stability_range(const CaseRecord& record, bool closed) {
  const DerivedTable* predicted = table_of(record, "stability");
  if (!predicted) return std::nullopt;
  const DerivedTable* observed = table_of(record, "stability_observed");
  const std::string contact = closed ? "closed" : "open";
  StabilityRange out;
  out.record = &record;
  out.closed = closed;
  for (const auto& row : predicted->rows) {
    const auto step = number_in(cell_in(*predicted, row, "step"));
    if (text_in(cell_in(*predicted, row, "contact")) != contact || !step) continue;
    StabilityCell one;
    one.step = *step;
    one.radius = number_in(cell_in(*predicted, row, "radius"));
    one.marginal = text_in(cell_in(*predicted, row, "marginal"));
    one.status = text_in(cell_in(*predicted, row, "status"));
    one.reason = text_in(cell_in(*predicted, row, "reason"));
    out.predicted = number_in(cell_in(*predicted, row, "limit_predicted"));
    out.observed = number_in(cell_in(*predicted, row, "limit_observed"));
    if (observed)
      for (const auto& seen : observed->rows)
        if (text_in(cell_in(*observed, seen, "contact")) == contact &&
            number_in(cell_in(*observed, seen, "step")) == step)
          one.behaviour = text_in(cell_in(*observed, seen, "behaviour"));
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
