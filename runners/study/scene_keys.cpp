#include "runners/study/scene_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/planes.hpp>

#include "runners/json/json_text.hpp"
#include "runners/study/body_keys.hpp"
#include "runners/study/histories.hpp"
#include "runners/study/study_files.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

using namespace keys;

namespace {

// What a structure begins with, whatever stands around it.
std::vector<Field> state_fields() {
  std::vector<Field> fields = {formula("displacement", "m", "x", false, Json("0"),
                                       "Absolute displacement u(x,0); beyond a stop under compliant laws only.")
                                   .as("u(x, 0)", "the initial displacement"),
                               formula("velocity", "m/s", "x", false, Json("0"), "Absolute velocity u_t(x,0).")
                                   .as("u_t(x, 0)", "the initial velocity")};
  return fields;
}

std::vector<Field> file_fields() {
  std::vector<Field> fields = {
      quiet(of_form(Field::Form::text, "file", Json(""),
                    "CSV of an assembled structure: dof, or node and component; displacement, velocity.")
                .as("initial state")),
      quiet(real("displacement_factor", "1", any, 1.0, "What the displacements of the file are multiplied by.")
                .as("factor of displacements", "the factor of initial displacements")),
      quiet(real("velocity_factor", "1", any, 1.0, "What its velocities are multiplied by.")
                .as("factor of velocities", "the factor of initial velocities"))};
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
           "\"constraint\": on Zᵀ(Kq − F) = 0, Z the kernel of a singular mass; \"least-squares\": on `mesh.modes`.")
          .as("projection", "the projection of the initial state"));
  keys.fields.back().axis = true;
  std::vector<Field> more = file_fields();
  keys.fields.push_back(std::move(more.front()));
  Field rest = quiet(single(word("equilibrium", {"frictionless"}, std::nullopt,
                                 "Whether it begins at rest under F(0) and its stops: K q = F(0) + Hᵀp; where they "
                                 "rub, \"frictionless\".")
                                .as("at rest under F(0)")));
  rest.fallback = Json(false);
  rest.or_flag = true;
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
  const Json rest = initial.value("equilibrium", Json(false));
  spec.frictionless = rest.is_string();
  spec.equilibrium = rest.is_string() || rest.get<bool>();
  return spec;
}

namespace {

Field fields_of_point() {
  Field field = of_form(Field::Form::words, "fields", Json(nullptr), "Of a beam there too: moment, shear, or both.");
  field.spec = word_parameter("fields", {"moment", "shear"}, std::nullopt, field.spec.text.c_str());
  field.nullable = true;
  return quiet(std::move(field));
}

bool shows(const Json& point, const char* field) {
  const Json fields = point.value("fields", Json::array());
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

}  // namespace

Field points_key() {
  ObjectForm point;
  point.fields = {of_form(Field::Form::text, "name", std::nullopt, "Letters, digits, '-' and '_'; each once."),
                  place("at", std::nullopt, "Place whose displacement is shown.").as(""),
                  quiet(optional(word("frame", {"absolute", "supports"}, std::nullopt,
                                      "What it counts from; absent: as `frame` of the scene."))),
                  fields_of_point()};
  return quiet(objects("points", "Places whose motion is shown; the first is where the tip is.", point).as("point"));
}

std::vector<Field> observed_of_stops() {
  ObjectForm radius;
  radius.fields = {
      single(real("slope_radius", "m", positive, std::nullopt, "r: the surface of a tube that bends moves by r θ."))};
  ObjectForm direction;
  direction.fields = {of_form(Field::Form::numbers, "direction", std::nullopt,
                              "Direction along the surface, at the nodes of the stop.")};
  direction.fields.back().count = 3;
  ObjectForm component;
  component.fields = {
      of_form(Field::Form::text, "component", std::nullopt, "Component along it, at the places of the stop.")};
  ObjectForm tangent;
  tangent.fields = {quiet(real("speed", "m/s", any, 0.0, "Speed of the surface; or its history.")
                              .as("speed of the surface", "the speed of the surface"))};
  tangent.fields.front().given.push_back(speed_history());
  tangent.ways = {radius, direction, component, ObjectForm()};
  Field along =
      quiet(object("tangent", Json(nullptr),
                   "Motion along the surface, for wear and friction; of a plane, a list of two; absent: none.", tangent)
                .as("tangent"));
  along.listed = {tangent};
  along.at_most = 2;
  ObjectForm coefficients;
  coefficients.fields = {real("static", "1", non_negative, std::nullopt, "μ of a point that stuck before.")
                             .as("static μ", "the static friction of a stop"),
                         real("dynamic", "1", non_negative, std::nullopt, "μ of a point that slides.")
                             .as("dynamic μ", "the dynamic friction of a stop")};
  Field friction =
      quiet(optional(real("friction", "1", non_negative, std::nullopt,
                          "Coefficient μ of its surface: needs a tangent, or a normal force; absent: none."))
                .as("μ", "the friction of a stop"));
  friction.axis = true;
  friction.given.push_back(coefficients);
  Field normal = quiet(optional(real("normal_force", "N", non_negative, std::nullopt,
                                     "Force that presses a friction damper, in the place of bounds; absent: none."))
                           .as("normal force", "the normal force of a damper"));
  normal.axis = true;
  return {std::move(along), std::move(friction), std::move(normal)};
}

Place read_place(const Json& json) {
  Place place;
  if (json.contains("x")) place.x = json.at("x").get<double>();
  place.node = json.value("node", "");
  place.component = json.value("component", "");
  place.point = json.value("point", "");
  place.body = json.value("body", "");
  if (json.contains("direction")) place.direction = json.at("direction").get<std::vector<double>>();
  if (json.contains("dofs"))
    for (const Json& one : json.at("dofs"))
      place.dofs.emplace_back(one.at("dof").get<int>(), one.at("weight").get<double>());
  return place;
}

std::vector<PointSpec> read_points(const Json& scene) {
  std::vector<PointSpec> points;
  const std::string frame = scene.value("frame", "absolute");
  for (const Json& one : scene.value("points", Json::array()))
    points.push_back({one.at("name").get<std::string>(), read_place(one.at("at")),
                      one.value("frame", frame) == "supports", shows(one, "moment"), shows(one, "shear")});
  return points;
}

std::vector<Field> parameters_of_stops() {
  const auto own = [](const char* key, const char* unit, const Range& range, const char* text) {
    Field field = quiet(optional(real(key, unit, range, std::nullopt, text)));
    field.axis = true;
    return field;
  };
  return {own("stiffness", "N/m", positive, "Its own stiffness, in the place of the contact law's; absent: the law's.")
              .as("stiffness", "the stop's own stiffness"),
          own("damping", "N s/m", non_negative, "Its own viscosity, in the place of the contact law's.")
              .as("damping", "the stop's own damping"),
          own("restitution", "1", {0, 1, false, false}, "Its own restitution, in the place of the time scheme's.")
              .as("restitution", "the stop's own restitution")};
}

StopParameters read_own(const Json& stop) {
  const auto value = [&](const char* key) {
    const Json given = stop.value(key, Json());
    return given.is_null() ? std::nullopt : std::optional(given.get<double>());
  };
  return {value("stiffness"), value("damping"), value("restitution")};
}

namespace {

TangentSpec read_tangent(const Json& given, const std::string& pointer, StudyFiles* files) {
  TangentSpec tangent{.slope_radius = given.value("slope_radius", 0.0),
                      .direction = given.value("direction", std::vector<double>()),
                      .component = given.value("component", "")};
  if (given.contains("speed")) read_speed(given.at("speed"), pointer + "/speed", files, tangent);
  return tangent;
}

}  // namespace

void read_surface(const Json& stop, const std::string& pointer, StudyFiles* files, NamedStop& out) {
  const Json tangents = stop.value("tangent", Json());
  const std::string here = pointer + "/tangent";
  if (tangents.is_object()) out.tangent = read_tangent(tangents, here, files);
  if (tangents.is_array()) out.tangent = read_tangent(tangents.at(0), here + "/0", files);
  if (tangents.is_array() && tangents.size() > 1) out.across = read_tangent(tangents[1], here + "/1", files);
  if (const Json given = stop.value("friction", Json()); given.is_number())
    out.friction = FrictionSpec{given.get<double>(), given.get<double>()};
  else if (given.is_object())
    out.friction = FrictionSpec{given.at("static").get<double>(), given.at("dynamic").get<double>()};
  if (const Json force = stop.value("normal_force", Json()); force.is_number()) out.normal_force = force.get<double>();
}

bool is_of_each(const Field& field, const Json& value, const std::string& pointer) {
  if (field.of_each.empty() || !value.is_string()) return false;
  const std::string text = value.get<std::string>(), word = text.substr(0, text.find('['));
  const auto in = [&](const std::vector<std::string>& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  const bool named = text.ends_with("]") && text.size() > word.size() + 2;
  if (named && in(field.of_each)) return true;
  if (word != text && !in(field.of_each))
    throw InputError(pointer, "no measure \"" + shortened(word) + "\" of a stop; expected one of " +
                                  quoted_list(field.of_each) + did_you_mean(word, field.of_each));
  if (in(field.of_each) && (word != text || !in(field.spec.words)))
    throw InputError(pointer, quote(value) + " says no name; expected " + word + "[NAME]");
  return false;
}

namespace {

const std::vector<std::string> both_components = {plane_components.begin(), plane_components.end()};

}  // namespace

Field planes_key() {
  return quiet(integer("planes", {1, 2, false, false}, 1, "2: it bends along z as well, w_y and w_z at each node.")
                   .as("planes"));
}

Field EI_z_key() {
  return quiet(single(real("EI_z", "N m²", positive, 0.0, "Along z, of a beam of `planes` 2; absent: EI.")
                          .as("EI along z", "the bending stiffness EI along z")));
}

Field components_of_support() {
  Field field = of_form(Field::Form::words, "components", Json(both_components),
                        "What it holds of a beam of `planes` 2: uy, uz or both.");
  field.spec = word_parameter("components", both_components, std::nullopt, field.spec.text.c_str());
  return quiet(std::move(field));
}

Field component_key(const char* text) {
  return quiet(word("component", both_components, "uy", text));
}

std::vector<Field> initial_across_keys() {
  return {quiet(formula("displacement_z", "m", "x", false, Json("0"), "u_z(x,0) of a beam of `planes` 2.")
                    .as("u_z(x, 0)", "the initial displacement along z")),
          quiet(formula("velocity_z", "m/s", "x", false, Json("0"), "Its rate.")
                    .as("u_z,t(x, 0)", "the initial velocity along z"))};
}

Field clearance_key() {
  Field components = of_form(Field::Form::words, "components", Json(both_components),
                             "The two displacements in its plane, at its place.");
  components.spec.type = ParameterSpec::Type::word;
  Field sides = integer("sides", {3, 720, false, false}, 16,
                        "Sides of the polygon that rigid laws meet; compliant laws meet the circle itself.")
                    .as("sides", "the number of sides");
  sides.axis = true;
  Field offset = of_form(Field::Form::numbers, "offset", Json::array({0.0, 0.0}),
                         "Where the centre is, from where the place has no displacement: along both components.");
  offset.spec.unit = "m";
  offset.repeats = true;
  ObjectForm keys;
  keys.fields = {real("radius", "m", positive, std::nullopt, "How far the place may move from the axis.")
                     .as("within", "the radius of a clearance"),
                 std::move(sides), quiet(std::move(offset)), std::move(components)};
  return quiet(object("clearance", Json(nullptr), "A circle round the place, in the place of bounds.", keys));
}

std::array<bool, 2> read_components(const Json& support) {
  if (!support.contains("components")) return {true, true};
  const auto words = support.at("components").get<std::vector<std::string>>();
  const auto has = [&](const char* word) { return std::find(words.begin(), words.end(), word) != words.end(); };
  return {has(plane_components[0]), has(plane_components[1])};
}

void add_stop(NamedStop stop, const Json& one, std::size_t entry, std::vector<NamedStop>& rows) {
  stop.entry = entry;
  const std::string pointer = pointer_to("/scene/stops", entry);
  const auto alone = [](const Place& place) {
    return !place.node.empty() && place.component.empty() && place.direction.empty();
  };
  if (!one.contains("clearance")) {
    if (alone(stop.at) || (stop.to && alone(*stop.to)))
      throw InputError(pointer + (alone(stop.at) ? "/at" : "/to"),
                       "a node without component or direction; expected one of them, or a clearance");
    rows.push_back(std::move(stop));
    return;
  }
  const Json& given = one.at("clearance");
  const auto components = given.at("components").get<std::vector<std::string>>();
  if (components.size() != 2)
    throw InputError(pointer + "/clearance/components",
                     std::to_string(components.size()) + " components; expected two, in the plane of the circle");
  const auto offset = given.value("offset", std::vector<double>{0, 0});
  if (offset.size() != 2)
    throw InputError(pointer + "/clearance/offset",
                     fmt::format("{} number{}; expected two, along the components of the circle", offset.size(),
                                 offset.size() == 1 ? "" : "s"));
  for (NamedStop& row : clearance_rows(stop, {.radius = given.at("radius").get<double>(),
                                             .sides = given.at("sides").get<int>(),
                                             .offset = {offset[0], offset[1]},
                                             .components = {components[0], components[1]}}))
    rows.push_back(std::move(row));
}

std::string pointer_in_study(const StopsSpec& stops, const std::string& pointer) {
  const std::string before = "/scene/stops/";
  if (stops.named.empty() || !pointer.starts_with(before)) return pointer;
  const std::size_t end = std::min(pointer.find('/', before.size()), pointer.size());
  const auto number = number_in(pointer.substr(before.size(), end - before.size()));
  const auto row = number && *number >= 0 ? static_cast<std::size_t>(*number) : stops.named.size();
  return row < stops.named.size() ? before + std::to_string(stops.named[row].entry) + pointer.substr(end) : pointer;
}

}  // namespace ricochet
