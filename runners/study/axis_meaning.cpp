#include "runners/study/axis_meaning.hpp"

#include <algorithm>
#include <stdexcept>

#include "runners/study/declared_keys.hpp"
#include "runners/study/study.hpp"

namespace ricochet {
namespace {

// Where the study format has the key that a column is of.
std::string pointer_of(const std::string& column) {
  std::string pointer = "/" + (column == residual_axis ? std::string("residual") : column);
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  if (column == residual_axis || column == "elements" || column == "modes") return "/mesh" + pointer;
  if (is_method_role(column)) return "/methods" + pointer;
  return column == "step" || column == "steps_per_period" || column == "march" ? pointer : "/scene" + pointer;
}

// Words and truth values have none.
std::string unit_of(const ParameterSpec& spec) {
  const bool number = spec.type == ParameterSpec::Type::real || spec.type == ParameterSpec::Type::integer;
  return !number ? "" : spec.unit.empty() ? "1" : spec.unit;
}

// Plugins declare their parameters without a full stop.
std::string sentence(const std::string& text) {
  return text.empty() || text.ends_with('.') ? text : text + '.';
}

// What the plugins of a role say of one of their parameters, each by its name where they say different things. Numbers
// of different units have none in common.
Column parameter_meaning(const std::string& column, const std::string& role, const std::string& key, const Study& study,
                         const Registry& registry) {
  std::vector<std::pair<std::string, const ParameterSpec*>> said;
  for (const StudyCase& one : study.cases) {
    for (const auto& [of, method] : methods_of(one)) {
      const bool known = std::any_of(said.begin(), said.end(),
                                     [&, name = method->name](const auto& other) { return other.first == name; });
      const PluginManual* manual = role != role_name(of) || known ? nullptr : registry.manual(of, method->name);
      if (!manual) continue;
      for (const ParameterSpec& spec : manual->parameters)
        if (spec.key == key) said.emplace_back(method->name, &spec);
    }
  }
  Column out = axis_meaning(column, study.resolved);
  if (said.empty()) return out;
  out.unit = unit_of(*said.front().second);
  out.text = sentence(said.front().second->text);
  const bool same = std::all_of(said.begin(), said.end(), [&](const auto& one) {
    return sentence(one.second->text) == out.text && unit_of(*one.second) == out.unit;
  });
  if (same) return out;
  if (std::any_of(said.begin(), said.end(), [&](const auto& one) { return unit_of(*one.second) != out.unit; }))
    out.unit.clear();
  out.text.clear();
  for (const auto& [name, spec] : said)
    out.text += (out.text.empty() ? "" : " ") + name + (unit_of(*spec) == out.unit ? "" : " (" + unit_of(*spec) + ")") +
                ": " + sentence(spec->text);
  return out;
}

}  // namespace

const std::vector<std::string>& method_roles() {
  static const std::vector<std::string> roles = [] {
    std::vector<std::string> names;
    for (const Role role : marched_roles) names.emplace_back(role_name(role));
    return names;
  }();
  return roles;
}

bool is_method_role(const std::string& column) {
  return std::find(method_roles().begin(), method_roles().end(), column) != method_roles().end();
}

namespace {

template <class Case>
auto& choice_of(Case& study_case, Role role) {
  switch (role) {
    case Role::mass:
      return study_case.mass;
    case Role::contact:
      return study_case.contact;
    case Role::friction:
      return study_case.friction;
    case Role::time:
      return study_case.time;
    case Role::reference:
      break;
  }
  throw std::logic_error("a case crosses no references");
}

}  // namespace

MethodChoice& method_of(StudyCase& study_case, Role role) {
  return choice_of(study_case, role);
}

std::vector<std::pair<Role, const MethodChoice*>> methods_of(const StudyCase& study_case) {
  std::vector<std::pair<Role, const MethodChoice*>> all;
  for (const Role role : marched_roles)
    if (const MethodChoice& method = choice_of(study_case, role); !method.name.empty()) all.emplace_back(role, &method);
  return all;
}

std::string spoken_choice(const std::string& column) {
  static const std::string times = " × ";
  if (const std::size_t at = column.find(times); at != std::string::npos) {
    const std::string one = column.substr(0, at), other = column.substr(at + times.size());
    return axis_role(one) == axis_role(other) ? spoken_choice(axis_role(one)) + " with its parameters"
                                              : spoken_choice(one) + " together with " + spoken_choice(other);
  }
  const std::string words = words_at(pointer_of(column));
  return words.empty() ? column : words;
}

std::vector<std::string> column_parts(const std::string& column) {
  std::vector<std::string> parts = {""};
  for (const char c : column)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::string axis_role(const std::string& column) {
  const std::string first = column.substr(0, column.find('.'));
  return is_method_role(first) ? first : column;
}

Column axis_meaning(const std::string& column, const Json& resolved) {
  if (const Field* field = declared_at(pointer_of(column), resolved))
    return {column, field->spec.type == ParameterSpec::Type::real ? field->spec.unit : unit_of(field->spec),
            field->spec.text};
  if (const std::string role = axis_role(column); role != column)
    return {column, "",
            "Parameter " + column.substr(role.size() + 1) + " of the method in the column " + role +
                "; \"ricochet describe\" says what it is."};
  return {column, "", "A value of the scene that differs between the cases."};
}

std::vector<Column> axis_meanings(const Study& study, const Registry& registry) {
  std::vector<Column> columns;
  for (const std::string& column : study.columns) {
    const std::vector<std::string> path = column_parts(column);
    const bool method = path.size() > 1 && is_method_role(path.front());
    columns.push_back(
        method ? parameter_meaning(column, path.front(), column.substr(path.front().size() + 1), study, registry)
               : axis_meaning(column, study.resolved));
  }
  return columns;
}

std::map<std::string, std::string> method_words(const Study& study, const Registry& registry) {
  std::map<std::string, std::string> words;
  const auto add = [&](Role role, const MethodChoice& method) {
    const PluginManual* manual = registry.manual(role, method.name);
    if (manual && !manual->words.empty()) words[std::string(role_name(role)) + " " + method.name] = manual->words;
  };
  for (const StudyCase& one : study.cases) {
    for (const auto& [role, method] : methods_of(one)) add(role, *method);
    if (one.of_reference) add(Role::reference, one.references.front());
  }
  return words;
}

}  // namespace ricochet
