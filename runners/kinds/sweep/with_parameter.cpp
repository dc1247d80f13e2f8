#include "runners/kinds/sweep/with_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/supports.hpp>

#include "runners/json/json_text.hpp"
#include "runners/kinds/sweep/forcing.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/declared_keys.hpp"
#include "runners/study/read_scene.hpp"
#include "runners/study/scene_keys.hpp"

namespace ricochet {
namespace {

constexpr const char* random_prefix = "random-";  // of the names of random starts, before their number

/// A scalar of the scene: where it is, what declares it.
struct Scalar {
  std::string pointer;
  const Field* field = nullptr;
};

void collect(const ObjectForm& form, const Json& value, const std::string& pointer, std::vector<Scalar>& scalars) {
  for (const Field* field : fields_of(form, value, pointer)) {
    const std::string here = pointer_to(pointer, field->key());
    const auto found = value.find(field->key());
    const bool number = field->form == Field::Form::formula ||
                        (field->form == Field::Form::scalar && field->spec.type == ParameterSpec::Type::real);
    if (found == value.end()) {
      // What is not written out has its default.
      if (number && field->quiet && field->fallback && !field->fallback->is_null()) scalars.push_back({here, field});
      continue;
    }
    const std::vector<StandingObject> objects = objects_at(*field, *found);
    for (const StandingObject& one : objects)
      collect(*one.form, *one.value, one.step.empty() ? here : pointer_to(here, one.step), scalars);
    if (!objects.empty()) continue;
    if (field->form == Field::Form::place && found->contains("x"))
      scalars.push_back({pointer_to(here, "x"), field});
    else if (number || (field->form == Field::Form::place && found->is_number()))
      scalars.push_back({here, field});
    else if (field->form == Field::Form::places && found->is_array())
      for (std::size_t i = 0; i < found->size(); ++i)
        if ((*found)[i].is_number()) scalars.push_back({pointer_to(here, i), field});
  }
}

std::vector<Scalar> scalars_of(const Json& scene) {
  std::vector<Scalar> scalars;
  collect(scene_form(), scene, "/scene", scalars);
  return scalars;
}

// Whether a value multiplies what stands there: a formula of x or t, and no number in words.
bool is_factor(const Json& old, const Field& field, const std::string& pointer) {
  if (!old.is_string()) return false;
  const Formula formula(old.get<std::string>(), pointer, field.variables);
  return formula.uses_x() || formula.uses_t();
}

// The number or the formula that the value makes of what stands there.
Json changed(const Json& old, const Field& field, const std::string& pointer, double value) {
  if (old.is_null()) throw InputError(pointer, "there is no stop here (null) that a parameter could move");
  if (field.form == Field::Form::scalar && check_parameter(field.spec, value))
    throw InputError(
        pointer, fmt::format("the value {} is impossible; expected a number in {}{}", value, field.spec.range.text(),
                             field.spec.unit.empty() || field.spec.unit == "1" ? "" : ", in " + field.spec.unit));
  if (!is_factor(old, field, pointer)) return value;
  return fmt::format("({})*({})", value, old.get<std::string>());
}

void change_scene(StudyCase& one, const std::string& pointer, double value) {
  const std::vector<Scalar> scalars = scalars_of(one.scene_json);
  const auto scalar =
      std::find_if(scalars.begin(), scalars.end(), [&](const Scalar& known) { return known.pointer == pointer; });
  if (scalar == scalars.end()) throw InputError(pointer, "names no number of this scene");
  const Json::json_pointer there(pointer.substr(std::string("/scene").size()));
  if (!one.scene_json.contains(there)) one.scene_json[there] = *scalar->field->fallback;
  Json& place = one.scene_json[there];
  place = changed(place, *scalar->field, pointer, value);
}

void change_method(StudyCase& one, const std::string& role, MethodChoice& method, const std::string& pointer,
                   double value) {
  const std::string key = pointer.substr(std::string("/methods/").size() + role.size() + 1);
  const auto& known = method.parameters.values();
  const auto found = known.find(key);
  if (found == known.end() ||
      (!std::holds_alternative<double>(found->second) && !std::holds_alternative<long long>(found->second)))
    throw InputError(pointer, fmt::format("the {} method \"{}\" has no real parameter \"{}\"", role, method.name, key));
  for (const auto& [swept, spec] : one.swept)
    if (swept == pointer)
      if (const auto problem = check_parameter(spec, value))
        throw InputError(pointer, fmt::format("the value {} is impossible: {}", value, *problem));
  method.parameters.set(key, value);
  for (auto& [name, axis] : one.axes)
    if (name == role + "." + key) axis = value;
}

}  // namespace

StudyCase with_parameter(const StudyCase& study_case, const std::string& pointer, double value) {
  return with_parameters(study_case, {{pointer, value}});
}

StudyCase with_parameters(const StudyCase& study_case, const std::vector<std::pair<std::string, double>>& values) {
  StudyCase one = study_case;
  bool scene = false;
  for (const auto& [pointer, value] : values) {
    if (!std::isfinite(value)) throw InputError(pointer, "the value is not a finite number");
    if (pointer.starts_with("/scene/")) {
      change_scene(one, pointer, value);
      scene = true;
      continue;
    }
    const auto role = std::find_if(marched_roles.begin(), marched_roles.end(), [&where = pointer](Role known) {
      return where.starts_with(fmt::format("/methods/{}/", role_name(known)));
    });
    if (role == marched_roles.end())
      throw InputError(pointer, "names neither a number of the scene nor a parameter of a method");
    change_method(one, role_name(*role), method_of(one, *role), pointer, value);
  }
  if (scene) {
    one.scene = on_mesh(read_scene(one.scene_json, one.files.get()), one.elements);
    try {
      check_scene(one.scene, one.elements, one.starts_beyond ? anywhere_beyond() : ForceBeyond());
    } catch (const BeyondStop&) {
      throw;
    } catch (const InputError& error) {
      const std::string in_study = pointer_in_study(one.scene.stops, error.pointer());
      throw InputError(pointer_in_bodies(in_study, one.scene_json), error.what());
    }
  }
  if (one.steps_per_period > 0) check_forcing(one.scene);
  return one;
}

StudyCase at_rest(const StudyCase& study_case) {
  StudyCase one = study_case;
  InitialSpec rest;
  rest.displacement = rest.velocity = Formula(0.0);
  rest.projection = one.scene.initial.projection;
  one.scene.initial = std::move(rest);
  if (one.scene_json.is_object())
    one.scene_json["initial"] = {{"displacement", "0"},
                                 {"velocity", "0"},
                                 {"projection", one.scene_json["initial"].value("projection", "none")}};
  return one;
}

std::vector<double> parameter_values(const Json& settings) {
  return settings.at("parameter").at("values").get<std::vector<double>>();
}

std::vector<StartSpec> starts_of(const Json& settings) {
  static const std::array<std::pair<const char*, StartSpec::Kind>, 4> words = {
      {{"rest", StartSpec::rest}, {"state", StartSpec::state}, {"up", StartSpec::up}, {"down", StartSpec::down}}};
  std::vector<StartSpec> starts;
  for (const Json& start : settings.at("start")) {
    if (start.is_object()) {
      for (int i = 1; i <= start.at("random").get<int>(); ++i)
        starts.push_back(
            {StartSpec::random, i, start.at("seed").get<std::uint64_t>(), random_prefix + std::to_string(i)});
      continue;
    }
    for (const auto& [word, kind] : words)
      if (start == word) starts.push_back({kind, 0, 0, word});
  }
  return starts;
}

bool is_random_start(const std::string& name) {
  return name.starts_with(random_prefix);
}

bool any_start(const std::vector<StartSpec>& starts, bool own_state) {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const StartSpec& start) { return start.own_state() == own_state; });
}

std::vector<GridAxis> grid_axes(const Json& settings) {
  std::vector<GridAxis> axes;
  for (const Json& axis : settings.at("axes"))
    axes.push_back({axis.at("pointer").get<std::string>(), axis.at("values").get<std::vector<double>>()});
  return axes;
}

bool names_initial_state(const std::string& pointer) {
  return pointer.starts_with("/scene/initial/");
}

std::vector<std::string> scene_scalars(const Json& scene) {
  std::vector<std::string> pointers;
  for (const Scalar& scalar : scalars_of(scene)) pointers.push_back(scalar.pointer);
  return pointers;
}

namespace {

// "/scene/support/amplitude" as the column of an axis.
std::string column_name(std::string pointer) {
  for (const std::string prefix : {"/scene/", "/methods/"})
    if (pointer.starts_with(prefix)) {
      pointer.erase(0, prefix.size());
      break;
    }
  std::replace(pointer.begin(), pointer.end(), '/', '.');
  return pointer;
}

// What a pointer of the study goes through, in the column `plain`.
Column swept_column(const StudyResults& results, const Column& plain, const nlohmann::ordered_json& where) {
  const std::optional<SweptAxis> swept = swept_axis(results, where);
  if (!swept) return plain;
  const auto& [axis, factor] = *swept;
  return {plain.name, factor ? "1" : axis.unit,
          plain.text + (factor ? " It multiplies " : " It is ") + axis.name + ": " + axis.text};
}

}  // namespace

std::optional<SweptAxis> swept_axis(const StudyResults& results, const nlohmann::ordered_json& where) {
  if (!where.is_object() || !where.contains("pointer") || !where.at("pointer").is_string()) return std::nullopt;
  const auto pointer = where.at("pointer").get<std::string>();
  SweptAxis out{axis_column(results, column_name(pointer))};
  try {
    const nlohmann::ordered_json::json_pointer place(pointer);
    if (pointer.starts_with("/scene/") && results.study.contains(place) && results.study.at(place).is_string())
      for (const Scalar& one : scalars_of(results.study.at("scene")))
        if (one.pointer == pointer) out.factor = is_factor(results.study.at(place), *one.field, pointer);
  } catch (const nlohmann::ordered_json::exception&) {
    return std::nullopt;
  }
  return out;
}

std::string swept_name(const StudyResults& results) {
  const auto parameter = results.study.find("parameter");
  if (parameter == results.study.end() || !parameter->is_object()) return "";
  return column_name(parameter->value("pointer", ""));
}

SweptColumns swept_columns(const StudyResults& results) {
  SweptColumns out;
  if (results.study.contains("parameter"))
    out.parameter = swept_column(results, out.parameter, results.study.at("parameter"));
  const auto axes = results.study.find("axes");
  if (axes == results.study.end() || !axes->is_array() || axes->size() != 2) return out;
  out.x = swept_column(results, out.x, axes->at(0));
  out.y = swept_column(results, out.y, axes->at(1));
  return out;
}

}  // namespace ricochet
