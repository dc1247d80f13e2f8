#include "runners/study/body_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/named_stops.hpp>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace {

std::vector<std::string> names_of(const Json& bodies) {
  std::vector<std::string> names;
  for (const auto& [name, ignored] : bodies.items()) names.push_back(name);
  return names;
}

bool meshed(const Json& structure) {
  return structure.at("type") == "beam" || structure.at("type") == "bar";
}

}  // namespace

Json check_bodies(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  if (!value.is_object() || value.empty())
    throw InputError(pointer, R"(expected bodies by name, {"rod": {structure}, …}, found )" + quote(value));
  Json result = Json::object();
  for (const auto& [name, structure] : value.items()) {
    check_name(name, pointer_to(pointer, name));
    result[name] = check_object(field.nested.front(), structure, pointer_to(pointer, name), axes);
  }
  return result;
}

bool by_body(const Json& value) {
  return value.is_object() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& one) { return one.is_object(); });
}

Json check_given(const Field& field, const Json& value, const std::string& pointer, std::vector<Axis>& axes) {
  if (field.form != Field::Form::object) return check_object(field.given.front(), value, pointer, axes);
  Json result = Json::object();
  for (const auto& [name, one] : value.items())
    result[name] = check_object(field.given.front(), one, pointer_to(pointer, name), axes);
  return result;
}

Json check_per_body(const Field& field, const Json& value, const std::string& pointer) {
  if (value.empty()) throw InputError(pointer, "an empty object; expected a number for each body");
  Json result = Json::object();
  for (const auto& [name, number] : value.items())
    result[name] = check_single(field, number, pointer_to(pointer, name));
  return result;
}

std::vector<int> of_bodies(const Json& numbers, const Json& scene, const std::string& pointer) {
  if (!scene.contains("bodies"))
    throw InputError(pointer, "numbers by body, and the scene has one structure; expected one number");
  const Json& bodies = scene.at("bodies");
  const std::vector<std::string> names = names_of(bodies);
  for (const auto& [name, ignored] : numbers.items())
    if (!bodies.contains(name))
      throw InputError(pointer_to(pointer, name), fmt::format("no body \"{}\" (bodies: {}){}", shortened(name),
                                                              quoted_list(names), did_you_mean(name, names)));
  std::vector<int> out;
  for (const std::string& name : names) out.push_back(numbers.contains(name) ? numbers.at(name).get<int>() : 0);
  return out;
}

std::vector<MeshChoice> meshes_of(const Json& mesh, const Json& scene) {
  const Json& given = mesh.at("elements");
  std::vector<MeshChoice> out;
  for (std::size_t i = 0; i < (given.is_array() ? given.size() : 1); ++i) {
    const Json& one = given.is_array() ? given[i] : given;
    const std::string pointer = given.is_array() ? pointer_to("/mesh/elements", i) : "/mesh/elements";
    MeshChoice& choice = out.emplace_back();
    if (!one.is_object()) {
      choice.elements = one.get<int>();
      continue;
    }
    std::vector<int> numbers = of_bodies(one, scene, pointer);
    choice.of_bodies = Json::object();
    choice.elements = 0;
    std::size_t b = 0;
    for (const auto& [name, structure] : scene.at("bodies").items()) {
      int& number = numbers[b++];
      if (!meshed(structure)) {
        if (number > 1)
          throw InputError(pointer_to(pointer, name),
                           fmt::format("{} elements; body {} has no mesh, expected 1", number, name));
        continue;
      }
      if (number == 0)
        throw InputError(pointer, fmt::format("says no number for body {}; expected one for each beam or bar", name));
      choice.of_bodies[name] = number;
      choice.elements += number;
    }
    for (std::size_t j = 0; j + 1 < out.size(); ++j)
      if (out[j].elements == choice.elements)
        throw InputError(pointer, fmt::format("{} elements in all, as the entry {} has; expected another number",
                                              choice.elements, j));
  }
  return out;
}

Json said_of_mesh(const Json& study, const std::string& key, const Json& number) {
  const Json& mesh = study.at("mesh");
  if (!study.at("scene").contains("bodies") || !mesh.contains(key)) return number;
  if (key == "elements") {
    for (const MeshChoice& choice : meshes_of(mesh, study.at("scene")))
      if (choice.elements == number && choice.of_bodies.is_object()) return choice.of_bodies;
    return number;
  }
  const Json& given = mesh.at(key);
  for (const Json& one : given.is_array() ? given : Json::array({given})) {
    int sum = 0;
    for (const Json& own : one.is_object() ? one : Json::object()) sum += own.get<int>();
    if (one.is_object() && sum == number) return one;
  }
  return number;
}

Json with_meshes(Json scene, const Json& of_bodies) {
  if (!of_bodies.is_null()) scene["elements"] = of_bodies;
  return scene;
}

const Json& structures_of(const Json& scene) {
  return scene.at(scene.contains("bodies") ? "bodies" : "structure");
}

bool has_structure(const Json& scene, const std::vector<std::string>& types) {
  const auto among = [&](const Json& structure) {
    return std::any_of(types.begin(), types.end(), [&](const std::string& type) {
      return structure.is_object() && structure.contains("type") && structure.at("type") == type;
    });
  };
  if (scene.contains("structure") && among(scene.at("structure"))) return true;
  if (!scene.contains("bodies") || !scene.at("bodies").is_object()) return false;
  for (const auto& [name, structure] : scene.at("bodies").items())
    if (among(structure)) return true;
  return false;
}

StructureSpec read_bodies(const Json& scene, const std::function<StructureSpec(const Json&)>& read) {
  const Json& given = scene.at("bodies");
  if (given.size() == 1) return read(given.begin().value());
  const Json meshes = scene.value("elements", Json::object());
  auto bodies = std::make_shared<Bodies>();
  int total = 0;
  for (const auto& [name, structure] : given.items()) {
    Body& body = bodies->all.emplace_back();
    body.name = name;
    in_body(name, [&, &json = structure] { body.structure = read(json); });
    body.elements = meshes.value(name, 1);
    total += meshes.value(name, 0);
  }
  bodies->elements = std::max(1, total);
  return AssembledSpec{.structure = nullptr, .bodies = bodies};
}

Json without_body(Json scene) {
  if (!scene.contains("bodies") || scene.at("bodies").size() != 1) return scene;
  const std::string name = scene.at("bodies").begin().key();
  const bool one_point = scene.at("bodies").begin()->value("type", "") == "oscillator";
  const auto clear = [&](Json& owner, const char* key) {
    if (!owner.is_object() || !owner.contains(key) || !owner[key].is_object()) return;
    if (owner[key].value("body", "") == name) owner[key].erase("body");
    if (one_point && owner[key].empty()) owner[key] = {{"x", 0}};
  };
  for (const char* list : {"stops", "load", "points"})
    if (scene.contains(list) && scene[list].is_array())
      for (Json& one : scene[list]) {
        clear(one, "at");
        clear(one, "to");
        if (one.is_object() && one.value("body", Json()) == name) one.erase("body");
      }
  return scene;
}

std::string pointer_in_bodies(const std::string& pointer, const Json& scene) {
  const std::string whole = "/scene/structure", begins = "/scene/initial/";
  if (pointer.starts_with(begins) && scene.contains("bodies") && scene.at("bodies").size() == 1 &&
      by_body(scene.at("initial")) && !pointer.starts_with(begins + scene.at("bodies").begin().key() + "/"))
    return pointer_to("/scene/initial", scene.at("bodies").begin().key()) + pointer.substr(begins.size() - 1);
  if (!scene.contains("bodies") || !pointer.starts_with(whole)) return pointer;
  if (scene.at("bodies").size() != 1) return "/scene/bodies" + pointer.substr(whole.size());
  return pointer_to("/scene/bodies", scene.at("bodies").begin().key()) + pointer.substr(whole.size());
}

bool all_along(const std::vector<BodyShape>& bodies) {
  return std::all_of(bodies.begin(), bodies.end(), [](const BodyShape& one) { return one.along; });
}

std::vector<BodyPlace> body_places(const std::vector<BodyShape>& bodies, const std::vector<BodyMeeting>& meetings) {
  std::vector<BodyPlace> out(bodies.size());
  std::vector<std::size_t> placed;
  const bool one_in_a_row = all_along(bodies);
  double longest = 0;
  for (const BodyShape& one : bodies) longest = std::max(longest, one.length);
  const double apart = 0.05 * longest;  // m, between bodies of a row
  const auto put = [&](std::size_t body, BodyPlace place, int step) {
    const auto from = [&](std::size_t b, double shift) { return bodies[b].first + shift - apart; };
    const auto covered = [&](std::size_t other) {
      return out[other].row == place.row &&
             (one_in_a_row || (from(body, place.shift) < from(other, out[other].shift) + bodies[other].length + apart &&
                               from(other, out[other].shift) < from(body, place.shift) + bodies[body].length + apart));
    };
    while (std::any_of(placed.begin(), placed.end(), covered)) place.row += step;
    out[body] = place;
    placed.push_back(body);
  };
  const auto has = [&](std::size_t body) { return std::find(placed.begin(), placed.end(), body) != placed.end(); };
  const auto join = [&] {
    for (const BodyMeeting& one : meetings) {
      const int up = one.below ? 1 : -1;
      if (has(one.at) == has(one.to)) continue;
      if (has(one.at))
        put(one.to, {out[one.at].shift + one.at_x - one.to_x, out[one.at].row + up}, up);
      else
        put(one.at, {out[one.to].shift + one.to_x - one.at_x, out[one.to].row - up}, -up);
      return true;
    }
    return false;
  };
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (has(body)) continue;
    int top = -1;
    for (const std::size_t other : placed) top = std::max(top, out[other].row);
    put(body, {-bodies[body].first, top + 1}, 1);
    while (join()) continue;
  }
  int lowest = 0;
  for (const BodyPlace& one : out) lowest = std::min(lowest, one.row);
  for (BodyPlace& one : out) one.row -= lowest;
  return out;
}

}  // namespace ricochet
