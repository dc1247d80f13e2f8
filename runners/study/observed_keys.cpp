#include "runners/study/observed_keys.hpp"

#include <algorithm>

#include "runners/json/json_text.hpp"

namespace ricochet {

using namespace keys;

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
                  place("at", std::nullopt, "Place whose displacement is shown."),
                  quiet(optional(word("frame", {"absolute", "supports"}, std::nullopt,
                                      "What it counts from; absent: as `frame` of the scene."))),
                  fields_of_point()};
  return quiet(objects("points", "Places whose motion is shown; the first is where the tip is.", point));
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
      of_form(Field::Form::text, "component", std::nullopt, "Component along it, at the nodes of the stop.")};
  ObjectForm tangent;
  tangent.ways = {radius, direction, component};
  return {quiet(object("tangent", Json(nullptr), "Motion along the surface, for wear; absent: none.", tangent))};
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
  return {own("stiffness", "N/m", positive, "Its own stiffness, in the place of the contact law's; absent: the law's."),
          own("damping", "N s/m", non_negative, "Its own viscosity, in the place of the contact law's."),
          own("restitution", "1", {0, 1, false, false}, "Its own restitution, in the place of the time scheme's.")};
}

StopParameters read_own(const Json& stop) {
  const auto value = [&](const char* key) {
    const Json given = stop.value(key, Json());
    return given.is_null() ? std::nullopt : std::optional(given.get<double>());
  };
  return {value("stiffness"), value("damping"), value("restitution")};
}

std::optional<TangentSpec> read_tangent(const Json& stop) {
  const Json given = stop.value("tangent", Json());
  if (given.is_null()) return std::nullopt;
  return TangentSpec{given.value("slope_radius", 0.0), given.value("direction", std::vector<double>()),
                     given.value("component", "")};
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
    throw InputError(pointer, "no measure \"" + shortened(word) + "\" of a stop" + did_you_mean(word, field.of_each));
  if (in(field.of_each) && (word != text || !in(field.spec.words)))
    throw InputError(pointer, quote(value) + " says no name; expected " + word + "[NAME]");
  return false;
}

}  // namespace ricochet
