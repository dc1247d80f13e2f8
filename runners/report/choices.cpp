#include "runners/report/choices.hpp"

#include <algorithm>
#include <set>

#include "runners/report/html.hpp"
#include "runners/report/quantity.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

constexpr const char* mass_colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#444444"};
constexpr std::size_t no_value = static_cast<std::size_t>(-1);

bool is_among(const std::vector<std::string>& list, std::string_view item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// So many significant digits, `least` at least, that these numbers have texts of their own.
int digits_of(const std::vector<double>& ascending, int least) {
  constexpr int most = 17;
  for (int digits = least; digits < most; ++digits) {
    const auto alike = [&](double a, double b) { return short_number(a, digits) == short_number(b, digits); };
    if (std::adjacent_find(ascending.begin(), ascending.end(), alike) == ascending.end()) return digits;
  }
  return most;
}

}  // namespace

std::string axis_words(const Cell& cell) {
  const auto number = cell.whole() ? std::nullopt : cell.number();
  return number ? report::exact_text(*number) : cell.text();
}

std::string axis_words(const CaseRecord& record, std::string_view column) {
  for (const auto& [name, value] : record.axes)
    if (name == column) return axis_words(cell_of(value));
  return "";
}

std::string label_word(const std::string& column) {
  if (is_method_role(column)) return "";
  return (axis_role(column) == column ? column : column.substr(column.rfind('.') + 1)) + " ";
}

bool is_refinement(const std::string& column) {
  return column == "step" || column == "elements" || column == "modes" || column == "steps_per_period";
}

Choices::Choices(const StudyResults& results) : results_(results) {
  if (const auto found = results.study.find("compare"); found != results.study.end() && found->is_string())
    asked_ = found->get<std::string>();
  for (const std::string& column : results.columns) {
    Values& own = values_[column];
    own.unit = report::shown_unit(axis_column(results, column).unit);
    own.role = axis_role(column);
    std::map<std::string, std::size_t> places;
    std::set<double> numbers;
    std::set<std::size_t> methods;  // without references
    for (const CaseRecord& record : results.cases) {
      std::size_t at = no_value;
      if (std::string value = axis_words(record, column); !value.empty()) {
        const auto [place, fresh] = places.emplace(value, own.texts.size());
        at = place->second;
        if (fresh) {
          if (const auto number = number_in(value)) numbers.insert(*number);
          own.texts.push_back(std::move(value));
        }
      }
      own.at.push_back(at);
      if (!is_reference(record)) methods.insert(at);
    }
    own.numbers = {numbers.begin(), numbers.end()};
    own.digits = digits_of(own.numbers, fewest_digits);
    if (column == "step" || column == "steps_per_period") steps_ = column;
    if (methods.size() < 2) continue;
    varying_.push_back(column);
    // A refinement that is asked for is a choice.
    if (is_refinement(column) && column != asked_) continue;
    columns_.push_back(column);
    if (!is_among(choices_, own.role)) choices_.push_back(own.role);
    columns_of_[own.role].push_back(column);
    if (own.role != column) columns_of_[column] = {column};
  }
  // A parameter tells levels apart only where cases of one method differ in it.
  for (const std::string& column : columns_) {
    const std::string role = axis_role(column);
    if (role == column) continue;
    std::map<std::string, std::string> first;
    for (const CaseRecord& record : results.cases) {
      const auto [at, fresh] = first.emplace(text(record, role), text(record, column));
      if (!fresh && at->second != text(record, column)) differs_in_[column].insert(at->first);
    }
  }
  for (const CaseRecord& record : results.cases) {
    if (is_reference(record)) continue;
    if (const std::string mass = mass_label(record); !is_among(masses_, mass)) masses_.push_back(mass);
  }
  for (auto& [column, own] : values_)
    for (const std::string& value : own.texts) own.words.push_back(value_words(column, value));
}

const Choices::Values* Choices::known(const std::string& column) const {
  const auto found = values_.find(column);
  return found == values_.end() ? nullptr : &found->second;
}

const std::vector<std::string>& Choices::values(const std::string& column) const {
  static const std::vector<std::string> none;
  const Values* own = known(column);
  return own ? own->texts : none;
}

std::optional<std::size_t> Choices::place(const CaseRecord& record, const std::string& column) const {
  const Values* own = known(column);
  const std::size_t at = own ? own->at[static_cast<std::size_t>(&record - results_.cases.data())] : no_value;
  return at == no_value ? std::nullopt : std::optional(at);
}

bool Choices::varies(std::string_view column) const {
  return is_among(varying_, column);
}

std::vector<std::string> Choices::varying_without(const std::vector<std::string>& columns) const {
  std::vector<std::string> out;
  for (const std::string& column : varying_)
    if (!is_among(columns, column) && !is_among(columns, axis_role(column))) out.push_back(column);
  return out;
}

std::vector<std::string> Choices::constants() const {
  std::vector<std::string> out;
  if (results_.cases.empty()) return out;
  for (const std::string& column : results_.columns) {
    const std::string& value = text(results_.cases.front(), column);
    if (!varies(column) && !value.empty()) out.push_back(column + " " + value + unit_after(column));
  }
  return out;
}

const std::vector<std::string>& Choices::columns_of(const std::string& choice) const {
  static const std::vector<std::string> none;
  const auto found = columns_of_.find(choice);
  return found == columns_of_.end() ? none : found->second;
}

std::vector<std::string> Choices::scene_columns() const {
  std::vector<std::string> own;
  for (const std::string& column : columns_)
    if (axis_role(column) == column && !is_method_role(column) && column != "march") own.push_back(column);
  return own;
}

const std::string& Choices::text(const CaseRecord& record, const std::string& column) const {
  static const std::string none;
  const auto at = place(record, column);
  return at ? values_.at(column).texts[*at] : none;
}

const std::string& Choices::said(const CaseRecord& record, const std::string& column) const {
  static const std::string none;
  const auto at = place(record, column);
  return at ? values_.at(column).words[*at] : none;
}

const std::string& Choices::role_of(const std::string& column) const {
  const Values* own = known(column);
  return own ? own->role : column;
}

bool Choices::differs(const std::string& column, const std::string& method) const {
  const auto found = differs_in_.find(column);
  return found != differs_in_.end() && found->second.contains(method);
}

std::string Choices::key(const CaseRecord& record) const {
  return key(record, columns_);
}

std::string Choices::key(const CaseRecord& record, const std::vector<std::string>& columns) const {
  std::string key;
  for (const std::string& column : columns) key += text(record, column) + '\x1f';
  return key;
}

const std::string& Choices::unit_of(const std::string& column) const {
  static const std::string none;
  const Values* own = known(column);
  return own ? own->unit : none;
}

std::string Choices::unit_after(const std::string& column) const {
  const std::string& unit = unit_of(column);
  return unit.empty() ? "" : " " + unit;
}

std::string Choices::number_words(const std::string& column, double value) const {
  const Values* own = known(column);
  return short_number(value, own ? own->digits : fewest_digits);
}

const std::vector<double>& Choices::numbers_of(const std::string& column) const {
  static const std::vector<double> none;
  const Values* own = known(column);
  return own ? own->numbers : none;
}

std::optional<double> Choices::step(const CaseRecord& record) const {
  if (steps_.empty()) return std::nullopt;
  const auto number = number_in(text(record, steps_));
  if (!number || *number <= 0) return std::nullopt;
  return steps_ == "step" ? *number : 1 / *number;
}

std::optional<double> Choices::elements(const CaseRecord& record) const {
  if (!varies("modes")) return number_in(text(record, "elements"));
  if (const auto modes = number_in(text(record, "modes"))) return modes;
  // All dofs of the mesh are more than any number of modes that is named.
  const std::vector<double>& modes = numbers_of("modes");
  return modes.empty() ? std::nullopt : std::optional(2 * modes.back());
}

bool Choices::finer(const CaseRecord& a, const CaseRecord& b) const {
  const auto size = [&](const CaseRecord& one) {
    return std::pair(elements(one).value_or(1), number_in(text(one, "elements")).value_or(1));
  };
  return size(a) != size(b) ? size(a) > size(b) : step(a).value_or(1) < step(b).value_or(1);
}

bool Choices::on_finest_mesh(const CaseRecord& record) const {
  if (!varies("modes") || !varies("elements")) return true;
  const auto elements = number_in(text(record, "elements"));
  return !elements || *elements == numbers_of("elements").back();
}

std::vector<CaseGroup> Choices::group(const Cases& cases, const std::vector<std::string>& columns) const {
  std::vector<CaseGroup> groups;
  for (Cases& same : groups_of(cases, columns))
    groups.push_back({short_label(*same.front(), columns), std::move(same)});
  return groups;
}

const CaseRecord* Choices::find(std::string_view id) const {
  const auto found = std::find_if(results_.cases.begin(), results_.cases.end(),
                                  [&](const CaseRecord& record) { return record.id == id; });
  return found == results_.cases.end() ? nullptr : &*found;
}

std::string Choices::mass_label(const CaseRecord& record) const {
  std::string out = text(record, "mass");
  for (const std::string& column : results_.columns) {
    if (column == "mass" || axis_role(column) != "mass" || values(column).size() < 2) continue;
    if (const std::string& value = text(record, column); !value.empty()) out += ", " + label_word(column) + value;
  }
  return out;
}

std::size_t Choices::mass_place(const CaseRecord& record) const {
  return static_cast<std::size_t>(std::find(masses_.begin(), masses_.end(), mass_label(record)) - masses_.begin());
}

std::string Choices::colour(const CaseRecord& record) const {
  return mass_colours[mass_place(record) % std::size(mass_colours)];
}

std::vector<std::string> without(std::vector<std::string> columns, const std::vector<std::string>& own) {
  std::erase_if(columns, [&](const auto& one) { return std::find(own.begin(), own.end(), one) != own.end(); });
  return columns;
}

}  // namespace ricochet
