#include "runners/study/initial_keys.hpp"

#include <fmt/format.h>

#include "runners/json/json_text.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/plane_keys.hpp"
#include "runners/study/study_files.hpp"

namespace ricochet {

using namespace keys;

namespace {

// What a structure begins with, whatever stands around it.
std::vector<Field> state_fields() {
  std::vector<Field> fields = {formula("displacement", "m", "x", false, Json("0"),
                                       "Absolute displacement u(x,0); beyond a stop under compliant laws only."),
                               formula("velocity", "m/s", "x", false, Json("0"), "Absolute velocity u_t(x,0).")};
  return fields;
}

std::vector<Field> file_fields() {
  std::vector<Field> fields = {
      quiet(of_form(Field::Form::text, "file", Json(""),
                    "CSV of an assembled structure: dof, or node and component; displacement, velocity.")),
      quiet(real("displacement_factor", "1", any, 1.0, "What the displacements of the file are multiplied by.")),
      quiet(real("velocity_factor", "1", any, 1.0, "What its velocities are multiplied by."))};
  for (Field& field : initial_across_keys()) fields.push_back(std::move(field));
  return fields;
}

ObjectForm body_form() {
  ObjectForm keys;
  keys.fields = state_fields();
  for (Field& field : file_fields()) keys.fields.push_back(std::move(field));
  return keys;
}

Formula formula_of(const Json& initial, const char* key, const std::string& pointer) {
  if (!initial.contains(key)) return {};
  const Json& value = initial.at(key);
  return value.is_number() ? Formula(value.get<double>()) : Formula(value.get<std::string>(), pointer + "/" + key, "x");
}

InitialSpec read_state(const Json& initial, const std::string& pointer, const Json* structure, StudyFiles* files) {
  InitialSpec spec;
  spec.displacement = formula_of(initial, "displacement", pointer);
  spec.velocity = formula_of(initial, "velocity", pointer);
  spec.displacement_z = formula_of(initial, "displacement_z", pointer);
  spec.velocity_z = formula_of(initial, "velocity_z", pointer);
  const bool file = initial.contains("file");
  for (const char* key : {"displacement_factor", "velocity_factor"})
    if (initial.contains(key) && !file)
      throw InputError(pointer + "/" + key, "multiplies a file, and none is given; expected \"file\"");
  if (!file || !files) return spec;
  spec.dofs = files->initial(initial, *structure, pointer + "/file");
  for (DofState& state : spec.dofs) {
    state.displacement *= initial.value("displacement_factor", 1.0);
    state.velocity *= initial.value("velocity_factor", 1.0);
  }
  return spec;
}

}  // namespace

Field initial_key() {
  ObjectForm keys;
  keys.fields = state_fields();
  keys.fields.push_back(
      word("projection", {"none", "constraint", "least-squares"}, "none",
           "\"constraint\": on Zᵀ(Kq − F) = 0, Z the kernel of a singular mass; \"least-squares\": on `mesh.modes`."));
  keys.fields.back().axis = true;
  std::vector<Field> more = file_fields();
  keys.fields.push_back(std::move(more.front()));
  Field rest = quiet(of_form(Field::Form::scalar, "equilibrium", Json(false),
                             "Whether it begins at rest under F(0) and its stops: K q = F(0) + Hᵀp."));
  rest.spec.type = ParameterSpec::Type::boolean;
  keys.fields.push_back(std::move(rest));
  for (std::size_t i = 1; i < more.size(); ++i) keys.fields.push_back(std::move(more[i]));
  Field field = object("initial", Json::object(),
                       "Initial state, absolute unless `frame` says, of bodies by name; absent: at rest.", keys);
  field.given.push_back(body_form());
  return field;
}

std::vector<Json*> initial_objects(Json& scene) {
  Json& initial = scene["initial"];
  if (!by_body(initial)) return {&initial};
  std::vector<Json*> out;
  for (Json& one : initial) out.push_back(&one);
  return out;
}

InitialSpec read_initial(const Json& scene, StudyFiles* files) {
  const Json& initial = scene.at("initial");
  const std::string pointer = "/scene/initial";
  if (by_body(initial)) {
    InitialSpec spec;
    spec.displacement = spec.velocity = Formula(0.0);
    const Json& bodies = scene.contains("bodies") ? scene.at("bodies") : Json::object();
    std::vector<std::string> names;
    for (const auto& [name, ignored] : bodies.items()) names.push_back(name);
    for (const auto& [name, one] : initial.items()) {
      const std::string here = pointer_to(pointer, name);
      if (names.empty())
        throw InputError(here,
                         "an initial state by body, and the scene has one structure; expected displacement and "
                         "velocity");
      if (!bodies.contains(name))
        throw InputError(here, fmt::format("no body \"{}\" (bodies: {}){}", shortened(name), quoted_list(names),
                                           did_you_mean(name, names)));
      if (names.size() == 1) return read_state(one, here, &bodies.at(name), files);
      spec.of_bodies.push_back(read_state(one, here, &bodies.at(name), files));
      spec.of_bodies.back().body = name;
    }
    return spec;
  }
  const bool bodies = scene.contains("bodies"), several = bodies && scene.at("bodies").size() > 1;
  if (several && initial.contains("file"))
    throw InputError(pointer + "/file",
                     "a file of several bodies; expected an object by body, {\"name\": {\"file\": …}}");
  InitialSpec spec =
      read_state(initial, pointer, bodies ? &scene.at("bodies").begin().value() : &scene.at("structure"), files);
  spec.projection = initial.at("projection") == "constraint"      ? InitialSpec::Projection::constraint
                    : initial.at("projection") == "least-squares" ? InitialSpec::Projection::least_squares
                                                                  : InitialSpec::Projection::none;
  spec.equilibrium = initial.value("equilibrium", false);
  return spec;
}

}  // namespace ricochet
