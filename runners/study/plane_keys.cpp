#include "runners/study/plane_keys.hpp"

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/planes.hpp>

#include "runners/json/json_text.hpp"

namespace ricochet {

using namespace keys;

namespace {

const std::vector<std::string> both_components = {plane_components.begin(), plane_components.end()};

}  // namespace

Field planes_key() {
  return quiet(integer("planes", {1, 2, false, false}, 1, "2: it bends along z as well, w_y and w_z at each node."));
}

Field EI_z_key() {
  return quiet(single(real("EI_z", "N m²", positive, 0.0, "Along z, of a beam of `planes` 2; absent: EI.")));
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
  return {quiet(formula("displacement_z", "m", "x", false, Json("0"), "u_z(x,0) of a beam of `planes` 2.")),
          quiet(formula("velocity_z", "m/s", "x", false, Json("0"), "Its rate."))};
}

Field clearance_key() {
  Field components = of_form(Field::Form::words, "components", Json(both_components),
                             "The two displacements in its plane, at its place.");
  components.spec.type = ParameterSpec::Type::word;
  Field sides = integer("sides", {3, 720, false, false}, 16, "Sides of the polygon round the circle.");
  sides.axis = true;
  ObjectForm keys;
  keys.fields = {single(real("radius", "m", positive, std::nullopt, "How far the place may move from the axis.")),
                 std::move(sides), std::move(components)};
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
  for (NamedStop& row : clearance_rows(
           stop, {given.at("radius").get<double>(), given.at("sides").get<int>(), {components[0], components[1]}}))
    rows.push_back(std::move(row));
}

std::string pointer_in_study(const StopsSpec& stops, const std::string& pointer) {
  const std::string before = "/scene/stops/";
  if (stops.named.empty() || !pointer.starts_with(before)) return pointer;
  const std::size_t end = std::min(pointer.find('/', before.size()), pointer.size());
  const auto row = static_cast<std::size_t>(std::stoul(pointer.substr(before.size(), end - before.size())));
  return row < stops.named.size() ? before + std::to_string(stops.named[row].entry) + pointer.substr(end) : pointer;
}

}  // namespace ricochet
