#include "runners/report/axis_rows.hpp"

#include "runners/report/choices.hpp"

namespace ricochet::report {
namespace {

void extend_key(std::string& key, std::string_view column, const std::string& text) {
  if (text.empty()) return;
  key += column;
  key += '\x1e' + text + '\x1f';
}

}  // namespace

AxisPlaces::AxisPlaces(const StudyResults& results, const Table* table,
                       const std::vector<std::vector<std::string>>& keys) {
  if (!table) return;
  std::vector<size_t> places;
  for (size_t c = 0; c < table->columns.size(); ++c)
    if (const std::string& name = table->columns[c].name;
        std::find(results.columns.begin(), results.columns.end(), name) != results.columns.end()) {
      axes_.push_back(name);
      places.push_back(c);
    }
  for (size_t row = 0; row < keys.size(); ++row) {
    Row& cells = cells_.emplace_back();
    for (const size_t place : places) cells.push_back(table->rows[row][place]);
    std::string key;
    for (size_t axis = 0; axis < axes_.size(); ++axis) extend_key(key, axes_[axis], axis_text(row, axis));
    for (const std::string& one : keys[row]) extend_key(key, "", one);
    places_.emplace(std::move(key), row);
  }
}

std::string AxisPlaces::axis_text(size_t row, size_t axis) const {
  return axis_words(cells_[row][axis]);
}

std::optional<size_t> AxisPlaces::find(const CaseRecord& record, const std::vector<std::string>& keys,
                                       const std::vector<std::string>& but) const {
  std::string key;
  for (const std::string& column : axes_)
    if (std::find(but.begin(), but.end(), column) == but.end()) extend_key(key, column, axis_words(record, column));
  for (const std::string& one : keys) extend_key(key, "", one);
  const auto found = places_.find(key);
  return found == places_.end() ? std::nullopt : std::optional(found->second);
}

const CaseRecord* AxisPlaces::example(size_t row, const StudyResults& results) const {
  for (const CaseRecord& record : results.cases) {
    bool same = true;
    for (size_t axis = 0; axis < axes_.size(); ++axis) {
      const std::string value = axis_text(row, axis);
      same = same && (value.empty() || value == axis_words(record, axes_[axis]));
    }
    if (same) return &record;
  }
  return nullptr;
}

}  // namespace ricochet::report
