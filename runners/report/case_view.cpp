#include "runners/report/case_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"

namespace ricochet::report {
namespace {

constexpr const char* mass_colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#444444"};

bool contains(const std::vector<std::string>& list, std::string_view item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// What is added to `before` of a column that sets cases apart by these values.
std::string apart(const std::string& before, const std::string& column, const std::vector<std::string>& values) {
  return fmt::format("{}{} {}", before.empty() ? "" : "; ", column, fmt::join(values, ", "));
}

}  // namespace

std::string axis_text(const StudyResults& results, const std::string& column) {
  const std::size_t owner = column.find('.'), name = column.find('.', owner + 1);
  if (role_of(column) != column || owner == std::string::npos) return column;
  const std::string last = in_words(column.substr(column.rfind('.') + 1));
  if (name != std::string::npos && column.starts_with("bodies."))
    return last + " of " + column.substr(owner + 1, name - owner - 1);
  if (name != std::string::npos && column.starts_with("stops.")) {
    const nlohmann::ordered_json::json_pointer place("/scene/stops/" + column.substr(owner + 1, name - owner - 1) +
                                                     "/name");
    if (results.study.contains(place) && results.study.at(place).is_string())
      return last + " of " + results.study.at(place).get<std::string>();
  }
  const std::string said = spoken_choice(column);
  return said.starts_with("the ") ? said.substr(4) : said;
}

std::string shown_unit(const std::string& unit) {
  return unit == "1" ? "" : unit;
}

std::string with_unit(const Quantity& quantity) {
  const std::string unit = shown_unit(quantity.unit);
  return unit.empty() ? quantity.name : quantity.name + " (" + unit + ")";
}

std::string role_of(std::string_view column) {
  return axis_role(std::string(column));
}

std::string label_word(const std::string& column) {
  if (is_method_role(column)) return "";
  const std::size_t dot = role_of(column) != column ? column.rfind('.') : std::string::npos;
  return (dot == std::string::npos ? column : column.substr(dot + 1)) + " ";
}

CaseView::CaseView(const StudyResults& results) : results_(results) {
  for (const std::string& column : results.columns) {
    Values& found = values_[column];
    found.unit = shown_unit(axis_column(results, column).unit);
    bool absent = false;
    std::map<std::string, std::size_t> places;
    for (const CaseRecord& record : results.cases) {
      const std::string value = text(record, column);
      if (value.empty()) {
        absent = absent || !is_reference(record);
        found.at.push_back(no_value);
        continue;
      }
      const auto [place, fresh] = places.emplace(value, found.texts.size());
      if (fresh) found.texts.push_back(value);
      found.at.push_back(place->second);
    }
    if (found.texts.size() + absent > 1) varying_.push_back(column);
  }
  for (const CaseRecord& record : results.cases) {
    if (is_reference(record)) continue;
    const std::string mass = mass_label(record);
    if (!contains(masses_, mass)) masses_.push_back(mass);
  }
}

bool CaseView::varies(std::string_view column) const {
  return contains(varying_, column);
}

const std::vector<std::string>& CaseView::values(const std::string& column) const {
  static const std::vector<std::string> none;
  const auto found = values_.find(column);
  return found == values_.end() ? none : found->second.texts;
}

const std::string& CaseView::unit_of(const std::string& column) const {
  static const std::string none;
  const auto found = values_.find(column);
  return found == values_.end() ? none : found->second.unit;
}

std::vector<std::string> CaseView::constants() const {
  std::vector<std::string> out;
  if (results_.cases.empty()) return out;
  for (const std::string& column : results_.columns) {
    if (varies(column)) continue;
    const std::string value = text(results_.cases.front(), column);
    if (value.empty()) continue;
    const std::string& unit = unit_of(column);
    out.push_back(column + " " + value + (unit.empty() ? "" : " " + unit));
  }
  return out;
}

std::string CaseView::text(const CaseRecord& record, std::string_view column) {
  for (const auto& [name, value] : record.axes) {
    if (name != column) continue;
    if (value.is_null()) return "";
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return exact_text(value.get<double>());
    return value.dump();
  }
  return "";
}

std::string CaseView::label(const CaseRecord& record, const std::vector<std::string>& columns) const {
  if (is_reference(record)) return record.id;
  std::string out, previous_role;
  for (const std::string& column : columns) {
    if (values(column).size() < 2) continue;
    const std::string value = text(record, column);
    if (value.empty()) continue;
    const std::string role = role_of(column);
    if (!out.empty()) out += role == previous_role ? ", " : " · ";
    const std::string& unit = unit_of(column);
    out += label_word(column) + value + (unit.empty() ? "" : " " + unit);
    previous_role = role;
  }
  return out;
}

std::string CaseView::name(const CaseRecord& record, const std::vector<std::string>& columns) const {
  const std::string known = label(record, columns);
  return known.empty() ? "the one method" : known;
}

std::string CaseView::name_of(const std::string& id) const {
  const CaseRecord* record = find(id);
  return record ? name(*record) : id;
}

std::string CaseView::mass_label(const CaseRecord& record) const {
  std::string out = text(record, "mass");
  for (const std::string& column : results_.columns) {
    if (column == "mass" || role_of(column) != "mass" || values(column).size() < 2) continue;
    const std::string value = text(record, column);
    if (!value.empty()) out += ", " + label_word(column) + value;
  }
  return out;
}

std::size_t CaseView::mass_place(const CaseRecord& record) const {
  return static_cast<std::size_t>(std::find(masses_.begin(), masses_.end(), mass_label(record)) - masses_.begin());
}

std::string CaseView::colour(const CaseRecord& record) const {
  return mass_colours[mass_place(record) % std::size(mass_colours)];
}

std::vector<std::string> CaseView::varying_without(const std::vector<std::string>& excluded) const {
  std::vector<std::string> out;
  for (const std::string& column : varying_)
    if (!contains(excluded, column) && !contains(excluded, role_of(column))) out.push_back(column);
  return out;
}

std::vector<CaseGroup> CaseView::group(const Cases& cases, const std::vector<std::string>& columns) const {
  std::vector<CaseGroup> groups;
  for (Cases& same : groups_of(cases, columns)) groups.push_back({label(*same.front(), columns), std::move(same)});
  return groups;
}

const CaseRecord* CaseView::find(std::string_view id) const {
  const auto found = std::find_if(results_.cases.begin(), results_.cases.end(),
                                  [&](const CaseRecord& record) { return record.id == id; });
  return found == results_.cases.end() ? nullptr : &*found;
}

std::vector<std::string> CaseView::values_of(const Cases& cases, const std::string& column) const {
  const Values& all = values_.at(column);
  std::vector<std::string> out;
  std::vector<char> met(all.texts.size(), 0);
  for (const CaseRecord* record : cases) {
    const std::size_t at = all.at[static_cast<std::size_t>(record - results_.cases.data())];
    if (at == no_value || met[at] != 0) continue;
    met[at] = 1;
    out.push_back(all.texts[at]);
  }
  return out;
}

std::string CaseView::describe(const Cases& cases) const {
  const std::size_t total = results_.cases.size();
  if (cases.size() == total) return total == 1 ? "the one case" : fmt::format("all {} cases", total);
  std::string what;
  for (const std::string& column : varying_)
    if (const auto inside = values_of(cases, column); !inside.empty() && inside.size() < values(column).size())
      what += apart(what, column, inside);
  return fmt::format("{} of {} cases{}", cases.size(), total, what.empty() ? "" : " (" + what + ")");
}

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
  return cell_words(cells_[row][axis]);
}

std::optional<size_t> AxisPlaces::find(const CaseRecord& record, const std::vector<std::string>& keys,
                                       const std::vector<std::string>& but) const {
  std::string key;
  for (const std::string& column : axes_)
    if (std::find(but.begin(), but.end(), column) == but.end()) extend_key(key, column, CaseView::text(record, column));
  for (const std::string& one : keys) extend_key(key, "", one);
  const auto found = places_.find(key);
  return found == places_.end() ? std::nullopt : std::optional(found->second);
}

const CaseRecord* AxisPlaces::example(size_t row, const StudyResults& results) const {
  for (const CaseRecord& record : results.cases) {
    bool same = true;
    for (size_t axis = 0; axis < axes_.size(); ++axis) {
      const std::string value = axis_text(row, axis);
      same = same && (value.empty() || value == CaseView::text(record, axes_[axis]));
    }
    if (same) return &record;
  }
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
