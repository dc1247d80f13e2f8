#include "runners/study/axis_meaning.hpp"

#include <algorithm>
#include <ricochet/contract/errors.hpp>

#include "runners/study/check_object.hpp"
#include "runners/study/fields.hpp"
#include "runners/study/study.hpp"

namespace ricochet {
namespace {

// How the column of a clearance's sides ends.
constexpr const char* sides_of_clearance = ".clearance.sides";

const std::vector<std::string> method_roles = {"mass", "contact", "time"};

std::vector<std::string> split(const std::string& column) {
  std::vector<std::string> parts = {""};
  for (const char c : column)
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// The declaration of the key at the end of `path`; nothing where the format has none.
std::optional<ParameterSpec> spec_at(const ObjectForm& form, const Json& value, const std::vector<std::string>& path,
                                     std::size_t depth = 0) {
  if (depth == path.size() || !value.is_object()) return std::nullopt;
  for (const Field* field : fields_of(form, value, "")) {
    if (field->key() != path[depth]) continue;
    if (depth + 1 == path.size()) return field->spec;
    const auto found = value.find(field->key());
    if (field->form == Field::Form::object && found != value.end())
      return spec_at(field->nested.front(), *found, path, depth + 1);
    return std::nullopt;
  }
  return std::nullopt;
}

std::optional<ParameterSpec> spec_of(const std::vector<std::string>& path, const Json& resolved) {
  std::vector<std::string> whole = path;
  if (path.front() == residual_axis)
    whole = {"mesh", "residual"};
  else if (path.front() == "elements" || path.front() == "modes")
    whole.insert(whole.begin(), "mesh");
  else if (path.size() == 1 && std::find(method_roles.begin(), method_roles.end(), path.front()) != method_roles.end())
    whole.insert(whole.begin(), "methods");
  else if (path.front() != "step" && path.front() != "steps_per_period" && path.front() != "march")
    whole.insert(whole.begin(), "scene");
  try {
    return spec_at(study_form(), resolved, whole);
  } catch (const InputError&) {
    // No study of this format: nothing is known of its axes.
    return std::nullopt;
  }
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

// What the plugins of a role say of one of their parameters, each by its name where they say different things.
Column parameter_meaning(const std::string& column, const std::string& role, const std::string& key, const Study& study,
                         const Registry& registry) {
  std::vector<std::pair<std::string, const ParameterSpec*>> said;
  for (const StudyCase& one : study.cases) {
    const MethodChoice& method = role == "mass" ? one.mass : role == "contact" ? one.contact : one.time;
    const bool known =
        std::any_of(said.begin(), said.end(), [&](const auto& other) { return other.first == method.name; });
    if (known) continue;
    const Role of = role == "mass" ? Role::mass : role == "contact" ? Role::contact : Role::time;
    const PluginManual* manual = registry.manual(of, method.name);
    if (!manual) continue;
    for (const ParameterSpec& spec : manual->parameters)
      if (spec.key == key) said.emplace_back(method.name, &spec);
  }
  Column out = axis_meaning(column, study.resolved);
  if (said.empty()) return out;
  out.unit = unit_of(*said.front().second);
  out.text = sentence(said.front().second->text);
  const bool same = std::all_of(said.begin(), said.end(), [&](const auto& one) {
    return sentence(one.second->text) == out.text && unit_of(*one.second) == out.unit;
  });
  if (same) return out;
  out.text.clear();
  for (const auto& [name, spec] : said)
    out.text += (out.text.empty() ? "" : " ") + name + (unit_of(*spec) == out.unit ? "" : " (" + unit_of(*spec) + ")") +
                ": " + sentence(spec->text);
  return out;
}

}  // namespace

std::string spoken_choice(const std::string& column) {
  static const std::string times = " × ";
  if (const std::size_t at = column.find(times); at != std::string::npos) {
    const std::string one = column.substr(0, at), other = column.substr(at + times.size());
    return axis_role(one) == axis_role(other) ? spoken_choice(axis_role(one)) + " with its parameters"
                                              : spoken_choice(one) + " together with " + spoken_choice(other);
  }
  if (column == "mass") return "the mass matrix";
  if (column == "contact") return "the contact law";
  if (column == "time") return "the time scheme";
  if (column == "step") return "the step";
  if (column == "elements") return "the mesh";
  if (column == "modes") return "the number of modes";
  if (column == residual_axis) return "the residual of the modes";
  if (column == "steps_per_period") return "the number of steps per period";
  if (column.ends_with(sides_of_clearance)) return "the number of sides";
  static const std::pair<const char*, const char*> scene[] = {
      {"structure.damping.stiffness", "the viscosity α"},
      {"structure.damping.mass", "the damping η"},
      {"structure.damping", "the damping"},
      {"structure.stiffness", "the stiffness of the structure"},
      {"structure.mass", "the mass of the oscillator"},
      {"structure.force.amplitude", "the amplitude of the force"},
      {"structure.force.pulsation", "the pulsation of the force"},
      {"structure.EA", "the axial stiffness EA"},
      {"structure.rhoA", "the mass per length ρA"},
      {"structure.length", "the length"},
      {"structure.folder", "the files of the structure"},
      {"structure.tension", "the tension"},
      {"structure.added_mass", "the added mass"},
      {"structure.foundation", "the foundation"},
      {"structure.section.EI", "the bending stiffness EI"},
      {"structure.section.rhoS", "the mass per length ρS"},
      {"stops.lower", "the lower stop"},
      {"stops.upper", "the upper stop"},
      {"stops.at", "where stops act"},
      {"support.amplitude", "the amplitude of the support"},
      {"support.pulsation", "the pulsation of the support"},
      {"initial.displacement", "the initial displacement"},
      {"initial.velocity", "the initial velocity"},
      {"initial.projection", "the projection of the initial state"},
  };
  for (const auto& [name, said] : scene)
    if (column == name) return said;
  return column;
}

std::string axis_role(const std::string& column) {
  const std::string first = split(column).front();
  return std::find(method_roles.begin(), method_roles.end(), first) == method_roles.end() ? column : first;
}

Column axis_meaning(const std::string& column, const Json& resolved) {
  if (column.ends_with(sides_of_clearance)) return {column, "1", "Sides of the polygon of a clearance."};
  const std::vector<std::string> path = split(column);
  if (const auto spec = spec_of(path, resolved))
    return {column, spec->type == ParameterSpec::Type::real ? spec->unit : unit_of(*spec), spec->text};
  if (axis_role(column) != column)
    return {column, "",
            "Parameter " + column.substr(path.front().size() + 1) + " of the method in the column " + path.front() +
                "; \"ricochet describe\" says what it is."};
  return {column, "", "A value of the scene that differs between the cases."};
}

std::vector<Column> axis_meanings(const Study& study, const Registry& registry) {
  std::vector<Column> columns;
  for (const std::string& column : study.columns) {
    const std::vector<std::string> path = split(column);
    const bool method =
        path.size() > 1 && std::find(method_roles.begin(), method_roles.end(), path.front()) != method_roles.end();
    columns.push_back(
        method ? parameter_meaning(column, path.front(), column.substr(path.front().size() + 1), study, registry)
               : axis_meaning(column, study.resolved));
  }
  return columns;
}

std::map<std::string, std::string> method_words(const Study& study, const Registry& registry) {
  std::map<std::string, std::string> words;
  const auto add = [&](const char* name, Role role, const MethodChoice& method) {
    const PluginManual* manual = registry.manual(role, method.name);
    if (manual && !manual->words.empty()) words[std::string(name) + " " + method.name] = manual->words;
  };
  for (const StudyCase& one : study.cases) {
    add("mass", Role::mass, one.mass);
    add("contact", Role::contact, one.contact);
    add("time", Role::time, one.time);
    if (one.of_reference) add("reference", Role::reference, one.references.front());
  }
  return words;
}

}  // namespace ricochet
