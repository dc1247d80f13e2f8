#include "runners/report/axis_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"

namespace ricochet::report {
namespace {

/// As the axes of a case are written (see CaseView::text).
std::string cell_words(const Cell& cell) {
  const auto number = cell.whole() ? std::nullopt : cell.number();
  return number ? exact_text(*number) : cell.text();
}

void extend_key(std::string& key, std::string_view column, const std::string& text) {
  if (text.empty()) return;
  key += column;
  key += '\x1e' + text + '\x1f';
}

}  // namespace

AxisRows::AxisRows(const StudyResults& results, std::string_view table, std::vector<std::string> keys)
    : keys_(std::move(keys)) {
  const Table* found = find_table(results.derived, table);
  if (!found) return;
  rows_.emplace(*found);
  for (const Column& column : found->columns)
    if (std::find(results.columns.begin(), results.columns.end(), column.name) != results.columns.end())
      axes_.push_back(column.name);
  for (size_t row = 0; row < size(); ++row) {
    std::string key;
    for (const std::string& column : axes_) extend_key(key, column, text(row, column));
    for (const std::string& column : keys_) extend_key(key, column, text(row, column));
    places_.emplace(std::move(key), row);
  }
}

std::string AxisRows::text(size_t row, std::string_view column) const {
  return cell_words(rows_->cell(row, rows_->column_if_any(column)));
}

std::optional<double> AxisRows::number(size_t row, std::string_view column) const {
  return rows_->number(row, rows_->column_if_any(column));
}

Cell AxisRows::value(size_t row, std::string_view column) const {
  return rows_->cell(row, rows_->column_if_any(column));
}

bool AxisRows::flag(size_t row, std::string_view column) const {
  return rows_->truth(row, rows_->column_if_any(column)).value_or(false);
}

std::vector<std::string> AxisRows::values(std::string_view column) const {
  std::vector<std::string> out;
  for (size_t row = 0; row < size(); ++row) {
    std::string value = text(row, column);
    if (std::find(out.begin(), out.end(), value) == out.end()) out.push_back(std::move(value));
  }
  return out;
}

std::optional<size_t> AxisRows::find(const CaseRecord& record, const std::vector<std::string>& keys,
                                     const std::vector<std::string>& but) const {
  std::string key;
  for (const std::string& column : axes_)
    if (std::find(but.begin(), but.end(), column) == but.end()) extend_key(key, column, CaseView::text(record, column));
  for (size_t k = 0; k < keys_.size() && k < keys.size(); ++k) extend_key(key, keys_[k], keys[k]);
  const auto found = places_.find(key);
  return found == places_.end() ? std::nullopt : std::optional(found->second);
}

const CaseRecord* AxisRows::example(size_t row, const StudyResults& results) const {
  for (const CaseRecord& record : results.cases)
    if (std::all_of(axes_.begin(), axes_.end(), [&](const std::string& column) {
          const std::string value = text(row, column);
          return value.empty() || value == CaseView::text(record, column);
        }))
      return &record;
  return nullptr;
}

Quantity error_quantity(const std::string& error) {
  static const std::map<std::string, std::string> units = {
      {"tip-linf", "m"}, {"tip-l2", "m"}, {"energy", "J"}, {"impact-times", "s"}, {"impulse", "N s"}};
  const auto found = units.find(error);
  return {"error " + error, found == units.end() ? "1" : found->second};
}

std::string order_number(double order) {
  std::string text = fmt::format("{:.2f}", order);
  if (text == "-0.00") return "0.00";
  if (text[0] == '-') text.replace(0, 1, "−");
  return text;
}

std::string power_text(double value) {
  const double exponent = std::log10(value);
  if (std::abs(exponent - std::round(exponent)) > 1e-9) return number_text(value);
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const auto whole = std::lround(exponent);
  std::string out = whole < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(whole))) out += digits[c - '0'];
  return out;
}

}  // namespace ricochet::report
