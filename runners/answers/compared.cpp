#include "runners/answers/compared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/report/case_view.hpp"
#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/text.hpp"

namespace ricochet::answers {
namespace {

std::string last_part(const std::string& column) {
  const std::size_t dot = column.rfind('.');
  return dot == std::string::npos ? column : column.substr(dot + 1);
}

/// Letters of the field for names of parameters.
std::string symbol(const std::string& name) {
  static const std::map<std::string, std::string> letters = {
      {"alpha", "α"},         {"beta", "β"},     {"gamma", "γ"},       {"theta", "θ"},
      {"rho_infinity", "ρ∞"}, {"rho_inf", "ρ∞"}, {"restitution", "e"}, {"splitting_ratio", "γ"}};
  const auto found = letters.find(name);
  return found == letters.end() ? "" : found->second;
}

/// "-100*x" as "−100 x".
std::string formula_words(std::string text) {
  if (text.find('*') == std::string::npos) return text;
  std::replace(text.begin(), text.end(), '*', ' ');
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

struct AxisWords {
  const char *column, *before, *after;
};
// Keys of a scene as sentences call them.
constexpr AxisWords scene_words[] = {{"structure.damping.stiffness", "viscosity", ""},
                                     {"structure.damping.mass", "mass damping", ""},
                                     {"structure.damping", "damping", ""},
                                     {"structure.length", "length", ""},
                                     {"structure.stiffness", "stiffness", ""},
                                     {"structure.section.EI", "EI", ""},
                                     {"structure.section.rhoS", "ρS", ""},
                                     {"support.amplitude", "amplitude", ""},
                                     {"support.pulsation", "pulsation", ""},
                                     {"stops.lower", "lower stop", ""},
                                     {"stops.upper", "upper stop", ""},
                                     {"stops.at", "stops at", ""},
                                     {"initial.velocity", "initial velocity", ""},
                                     {"initial.displacement", "initial displacement", ""},
                                     {"initial.projection", "projection", ""},
                                     {"elements", "", " elements"},
                                     {"modes", "", " modes"},
                                     {"mode_residual", "residual", ""},
                                     {"steps_per_period", "", " steps per period"},
                                     {"march", "", ""}};

/// What its values are called by.
std::string word_of(const std::string& column) {
  for (const AxisWords& words : scene_words)
    if (column == words.column) return std::string(words.before) + words.after;
  return report::in_words(last_part(column));
}

/// A table of rows: too long for a sentence.
bool is_table(const std::string& value) {
  return value.starts_with("[[");
}

/// "plate" of stops.0.upper, "strap" of bodies.strap.stiffness, "contact" of contact.stiffness; "" of one part.
std::string owner_of(const std::string& column, const Json& study) {
  const std::vector<std::string> parts = column_parts(column);
  if (parts.size() < 2) return "";
  if (parts.front() == "bodies") return parts[1];
  const auto stop = number_in(parts[1]);
  if (parts.front() != "stops" || !stop) return report::in_words(parts[parts.size() - 2]);
  const Json::json_pointer name("/scene/stops/" + parts[1] + "/name");
  return study.contains(name) ? study.at(name).get<std::string>() : "stop " + short_number(*stop + 1);
}

/// Words of a key as they are said: "every step" of "every-step".
std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '-', ' ');
  return text;
}

}  // namespace

bool is_refinement(const std::string& column) {
  return column == "step" || column == "elements" || column == "modes" || column == "steps_per_period";
}

Compared::Compared(const StudyResults& results) : results_(results) {
  if (const auto found = results.study.find("compare"); found != results.study.end() && found->is_string())
    asked_ = found->get<std::string>();
  for (const std::string& column : results.columns) {
    std::vector<std::string> texts;
    std::vector<std::string> methods;  // without references
    for (const CaseRecord& record : results.cases) {
      texts.push_back(report::CaseView::text(record, column));
      if (!is_reference(record)) methods.push_back(texts.back());
    }
    std::set<double> numbers;
    for (const std::string& one : texts)
      if (const auto number = number_in(one)) numbers.insert(*number);
    if (column == "step" || column == "steps_per_period") steps_ = column;
    const bool varies =
        std::any_of(methods.begin(), methods.end(), [&](const auto& one) { return one != methods.front(); });
    texts_[column] = std::move(texts);
    numbers_[column] = {numbers.begin(), numbers.end()};
    if (!varies) continue;
    varying_.push_back(column);
    // A refinement that is asked for is a choice.
    if (is_refinement(column) && column != asked_) continue;
    columns_.push_back(column);
    if (const std::string choice = axis_role(column);
        std::find(choices_.begin(), choices_.end(), choice) == choices_.end())
      choices_.push_back(choice);
  }
  // A parameter tells levels apart only where cases of one method differ in it.
  for (const std::string& column : columns_) {
    const std::string role = axis_role(column);
    if (role == column) continue;
    const auto names = texts_.find(role);
    std::map<std::string, std::string> first;
    for (std::size_t k = 0; k < results.cases.size(); ++k) {
      const std::string name = names == texts_.end() ? "" : names->second[k];
      const auto [at, fresh] = first.emplace(name, texts_[column][k]);
      if (!fresh && at->second != texts_[column][k]) differs_in_[column][name] = true;
    }
  }
}

bool Compared::varies(const std::string& column) const {
  return std::find(varying_.begin(), varying_.end(), column) != varying_.end();
}

std::vector<std::string> Compared::columns_of(const std::string& choice) const {
  std::vector<std::string> own;
  for (const std::string& column : columns_)
    if (axis_role(column) == choice || column == choice) own.push_back(column);
  return own;
}

std::vector<std::string> Compared::scene_columns() const {
  std::vector<std::string> own;
  for (const std::string& column : columns_)
    if (axis_role(column) == column && !is_method_role(column) && column != "march") own.push_back(column);
  return own;
}

const std::string& Compared::text(const CaseRecord& record, const std::string& column) const {
  static const std::string none;
  const auto found = texts_.find(column);
  if (found == texts_.end()) return none;
  return found->second[static_cast<std::size_t>(&record - results_.cases.data())];
}

std::string Compared::key(const CaseRecord& record) const {
  return key(record, columns_);
}

std::string Compared::key(const CaseRecord& record, const std::vector<std::string>& columns) const {
  std::string key;
  for (const std::string& column : columns) key += text(record, column) + '\x1f';
  return key;
}

std::string Compared::method_words(const std::string& role, const std::string& name) const {
  const auto found = results_.method_words.find(role + " " + name);
  return found == results_.method_words.end() ? name : found->second;
}

std::string Compared::unit_of(const std::string& column) const {
  const std::string unit = report::shown_unit(axis_column(results_, column).unit);
  return unit.empty() ? "" : " " + unit;
}

const std::vector<double>& Compared::numbers_of(const std::string& column) const {
  static const std::vector<double> none;
  const auto found = numbers_.find(column);
  return found == numbers_.end() ? none : found->second;
}

std::string Compared::owner(const std::string& column) const {
  const std::string word = word_of(column);
  const bool alone = std::none_of(varying_.begin(), varying_.end(),
                                  [&](const std::string& other) { return other != column && word_of(other) == word; });
  return alone ? "" : owner_of(column, results_.study);
}

std::string Compared::spoken(const std::string& choice) const {
  const std::string own = owner_of(choice, results_.study);
  if (choice.starts_with("bodies.")) return "the " + report::in_words(last_part(choice)) + " of " + own;
  const std::string words = answers::spoken(choice);
  return choice.starts_with("stops.") && !owner(choice).empty() ? words + " at " + own : words;
}

std::string Compared::value_words(const std::string& column, const std::string& value) const {
  const std::string own = owner(column);
  return (own.empty() ? "" : own + " ") + own_words(column, value);
}

std::string Compared::own_words(const std::string& column, const std::string& value) const {
  const std::string role = axis_role(column);
  if (column == role && is_method_role(role)) return method_words(role, value);
  const auto number = number_in(value);
  const std::string shown = number ? short_number(*number) : formula_words(value);
  if (role != column) {
    const std::string name = last_part(column);
    if (const std::string letter = symbol(name); !letter.empty() && number)
      return letter + " = " + fraction_text(*number) + unit_of(column);
    if (is_table(value)) return table_words(column, value);
    // "implicit evaluation", "second-order start"; of a mass matrix the value says it: "P1".
    if (!number && value != "true" && value != "false")
      return role == "mass" ? value : value + " " + report::in_words(name);
    return report::in_words(name) + " " + shown + unit_of(column);
  }
  if (column == "march") return spaced(value);
  for (const AxisWords& words : scene_words)
    if (column == words.column) {
      const std::string unit = *words.after ? words.after : number ? unit_of(column) : "";
      return std::string(words.before) + (*words.before ? " " : "") + shown + unit;
    }
  return report::in_words(last_part(column)) + " " + shown + (number ? unit_of(column) : "");
}

std::string Compared::table_words(const std::string& column, const std::string& value) const {
  std::vector<std::string> tables;
  for (const CaseRecord& one : results_.cases)
    if (const std::string& other = text(one, column);
        is_table(other) && std::find(tables.begin(), tables.end(), other) == tables.end())
      tables.push_back(other);
  const auto number = std::find(tables.begin(), tables.end(), value) - tables.begin() + 1;
  return report::in_words(last_part(column)) + (tables.size() > 1 ? " table " + std::to_string(number) : " table");
}

std::string Compared::level(const CaseRecord& record, const std::string& choice) const {
  if (axis_role(choice) == choice && !is_method_role(choice))
    return text(record, choice).empty() ? "" : value_words(choice, text(record, choice));
  std::string out;
  const std::string& name = text(record, axis_role(choice));
  for (const std::string& column : columns_of(choice)) {
    const std::string& value = text(record, column);
    if (value.empty()) continue;
    if (column != axis_role(column)) {
      const auto found = differs_in_.find(column);
      if (column != choice && (found == differs_in_.end() || found->second.count(name) == 0)) continue;
    }
    out += (out.empty() ? "" : " ") + value_words(column, value);
  }
  return out;
}

std::string Compared::label(const CaseRecord& record, const std::vector<std::string>& choices) const {
  std::string out;
  for (const std::string& choice : choices)
    if (const std::string one = level(record, choice); !one.empty()) out += (out.empty() ? "" : ", ") + one;
  return out;
}

std::string Compared::words(const CaseRecord& record, const std::vector<std::string>& columns) const {
  std::string out, last;
  for (const std::string& column : columns) {
    const std::string& value = text(record, column);
    if (value.empty()) continue;
    const std::string role = axis_role(column);
    // A parameter that cases of one method share says nothing beside the method's name.
    const auto found = differs_in_.find(column);
    if (role != column && std::find(columns.begin(), columns.end(), role) != columns.end() &&
        (found == differs_in_.end() || !found->second.contains(text(record, role))))
      continue;
    out += (out.empty() ? "" : role == last ? " " : ", ") + value_words(column, value);
    last = role;
  }
  return out;
}

std::string Compared::name(const CaseRecord& record, const std::vector<std::string>& choices) const {
  std::string scheme, mass, law, rest;
  for (const std::string& choice : choices) {
    const std::string one = level(record, choice);
    if (one.empty()) continue;
    if (choice == "time")
      scheme = one;
    else if (choice == "mass")
      mass = "the " + one + " mass";
    else if (choice == "contact")
      law = one;
    else
      rest += ", " + one;
  }
  std::string out = scheme;
  if (!mass.empty()) out += (out.empty() ? "" : " on ") + mass;
  if (!law.empty()) out += (out.empty() ? "" : " with ") + law;
  out += rest;
  if (out.starts_with(", ")) out.erase(0, 2);
  return out.empty() ? "the one method" : out;
}

std::optional<double> Compared::step(const CaseRecord& record) const {
  if (steps_.empty()) return std::nullopt;
  const auto number = number_in(text(record, steps_));
  if (!number || *number <= 0) return std::nullopt;
  return steps_ == "step" ? *number : 1 / *number;
}

std::optional<double> Compared::elements(const CaseRecord& record) const {
  if (!varies("modes")) return number_in(text(record, "elements"));
  if (const auto modes = number_in(text(record, "modes"))) return modes;
  // All dofs of the mesh are more than any number of modes that is named.
  const auto known = numbers_.find("modes");
  return known == numbers_.end() || known->second.empty() ? std::nullopt : std::optional(2 * known->second.back());
}

bool Compared::finer(const CaseRecord& a, const CaseRecord& b) const {
  const auto size = [&](const CaseRecord& one) {
    return std::pair(elements(one).value_or(1), number_in(text(one, "elements")).value_or(1));
  };
  return size(a) != size(b) ? size(a) > size(b) : step(a).value_or(1) < step(b).value_or(1);
}

std::string Compared::mesh_words(double size) const {
  if (!varies("modes")) return short_number(size) + " elements";
  return size > numbers_of("modes").back() ? "all dofs" : short_number(size) + " modes";
}

bool Compared::on_finest_mesh(const CaseRecord& record) const {
  if (!varies("modes") || !varies("elements")) return true;
  const auto elements = number_in(text(record, "elements"));
  return !elements || *elements == numbers_.at("elements").back();
}

std::string Compared::step_words(double step) const {
  return steps_ == "steps_per_period" ? short_number(1 / step) + " steps per period"
                                      : "h = " + short_number(step) + " s";
}

std::vector<std::string> without(std::vector<std::string> columns, const std::vector<std::string>& own) {
  std::erase_if(columns, [&](const auto& one) { return std::find(own.begin(), own.end(), one) != own.end(); });
  return columns;
}

std::string spoken(const std::string& choice) {
  if (choice == "march") return "leaving out steps";
  static const std::string times = " × ";
  if (const std::size_t at = choice.find(times); at != std::string::npos) {
    const std::string one = axis_role(choice.substr(0, at)), other = axis_role(choice.substr(at + times.size()));
    return one == other ? spoken(one) : spoken(one) + " together with " + spoken(other);
  }
  const std::string known = spoken_choice(choice);
  if (known != choice) return known;
  const std::string last = last_part(choice);
  return spoken_choice(last) != last ? "the scene's " + last : report::in_words(last);  // not the mass matrix
}

std::string level_phrase(const std::string& choice, const std::string& level) {
  return choice == "mass" && !level.empty() ? "the " + level + " mass" : level;
}

}  // namespace ricochet::answers
