#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/text.hpp"

// What sentences, tables and figures call choices, their levels and cases.
namespace ricochet {
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

std::string Choices::method_words(const std::string& role, const std::string& name) const {
  const auto found = results_.method_words.find(role + " " + name);
  return found == results_.method_words.end() ? name : found->second;
}

std::string Choices::owner(const std::string& column) const {
  const std::string word = word_of(column);
  const bool alone = std::none_of(varying_.begin(), varying_.end(),
                                  [&](const std::string& other) { return other != column && word_of(other) == word; });
  return alone ? "" : owner_of(column, results_.study);
}

std::string Choices::spoken(const std::string& choice) const {
  const std::string own = owner_of(choice, results_.study);
  if (choice.starts_with("bodies.")) return "the " + report::in_words(last_part(choice)) + " of " + own;
  const std::string words = ricochet::spoken(choice);
  return choice.starts_with("stops.") && !owner(choice).empty() ? words + " at " + own : words;
}

std::string Choices::value_words(const std::string& column, const std::string& value) const {
  const std::string own = owner(column);
  return (own.empty() ? "" : own + " ") + own_words(column, value);
}

std::string Choices::own_words(const std::string& column, const std::string& value) const {
  const std::string role = axis_role(column);
  if (column == role && is_method_role(role)) return method_words(role, value);
  const auto number = number_in(value);
  const std::string shown = number ? number_words(column, *number) : formula_words(value);
  if (role != column) {
    const std::string name = last_part(column);
    if (const std::string letter = symbol(name); !letter.empty() && number)
      return letter + " = " + (fraction_text(*number) == short_number(*number) ? shown : fraction_text(*number)) +
             unit_after(column);
    if (is_table(value)) return table_words(column, value);
    // "implicit evaluation", "second-order start"; of a mass matrix the value says it: "P1".
    if (!number && value != "true" && value != "false")
      return role == "mass" ? value : value + " " + report::in_words(name);
    return report::in_words(name) + " " + shown + unit_after(column);
  }
  if (column == "march") return spaced(value);
  for (const AxisWords& words : scene_words)
    if (column == words.column) {
      const std::string unit = *words.after ? words.after : number ? unit_after(column) : "";
      return std::string(words.before) + (*words.before ? " " : "") + shown + unit;
    }
  return report::in_words(last_part(column)) + " " + shown + (number ? unit_after(column) : "");
}

std::string Choices::table_words(const std::string& column, const std::string& value) const {
  std::vector<std::string> tables = values(column);
  std::erase_if(tables, [](const std::string& one) { return !is_table(one); });
  const auto number = std::find(tables.begin(), tables.end(), value) - tables.begin() + 1;
  return report::in_words(last_part(column)) + (tables.size() > 1 ? " table " + std::to_string(number) : " table");
}

std::string Choices::level(const CaseRecord& record, const std::string& choice) const {
  const std::string& role = role_of(choice);
  if (role == choice && !is_method_role(choice)) return said(record, choice);
  std::string out;
  const std::string& name = text(record, role);
  for (const std::string& column : columns_of(choice)) {
    const std::string& value = said(record, column);
    if (value.empty() || (column != role && column != choice && !differs(column, name))) continue;
    out += (out.empty() ? "" : " ") + value;
  }
  return out;
}

std::string Choices::label(const CaseRecord& record, const std::vector<std::string>& choices) const {
  std::string out;
  for (const std::string& choice : choices)
    if (const std::string one = level(record, choice); !one.empty()) out += (out.empty() ? "" : ", ") + one;
  return out;
}

std::string Choices::words(const CaseRecord& record, const std::vector<std::string>& columns) const {
  std::string out, last;
  for (const std::string& column : columns) {
    const std::string& value = said(record, column);
    if (value.empty()) continue;
    const std::string& role = role_of(column);
    // A parameter that cases of one method share says nothing beside the method's name.
    if (role != column && std::find(columns.begin(), columns.end(), role) != columns.end() &&
        !differs(column, text(record, role)))
      continue;
    out += (out.empty() ? "" : role == last ? " " : ", ") + value;
    last = role;
  }
  return out;
}

std::string Choices::name(const CaseRecord& record, const std::vector<std::string>& choices) const {
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

std::string Choices::mesh_words(double size) const {
  if (!varies("modes")) return short_number(size) + " elements";
  return size > numbers_of("modes").back() ? "all dofs" : short_number(size) + " modes";
}

std::string Choices::step_words(double step) const {
  return steps_ == "steps_per_period" ? short_number(1 / step) + " steps per period"
                                      : "h = " + short_number(step) + " s";
}

std::string Choices::short_label(const CaseRecord& record, const std::vector<std::string>& columns) const {
  if (is_reference(record)) return record.id;
  std::string out, last;
  for (const std::string& column : columns) {
    const std::string& value = text(record, column);
    if (value.empty() || values(column).size() < 2) continue;
    const std::string role = axis_role(column);
    out += (out.empty() ? "" : role == last ? ", " : " · ") + label_word(column) + value + unit_after(column);
    last = role;
  }
  return out;
}

std::string Choices::short_name(const CaseRecord& record, const std::vector<std::string>& columns) const {
  const std::string label = short_label(record, columns);
  return label.empty() ? "the one method" : label;
}

std::string Choices::name_of(const std::string& id) const {
  const CaseRecord* record = find(id);
  return record ? short_name(*record) : id;
}

std::string Choices::describe(const Cases& cases) const {
  const std::size_t total = results_.cases.size();
  if (cases.size() == total) return total == 1 ? "the one case" : fmt::format("all {} cases", total);
  std::string what;
  for (const std::string& column : varying_) {
    InOrderMet<std::size_t, bool> met;
    for (const CaseRecord* record : cases)
      if (const auto at = place(*record, column)) met[*at] = true;
    std::vector<std::string> inside;
    for (const auto& [at, yes] : met.list()) inside.push_back(values(column)[at]);
    if (!inside.empty() && inside.size() < values(column).size())
      what += fmt::format("{}{} {}", what.empty() ? "" : "; ", column, fmt::join(inside, ", "));
  }
  return fmt::format("{} of {} cases{}", cases.size(), total, what.empty() ? "" : " (" + what + ")");
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

}  // namespace ricochet
