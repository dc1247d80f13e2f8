#include <algorithm>

#include "runners/json/json_text.hpp"
#include "runners/study/check_object.hpp"

namespace ricochet {
namespace {

const char* const place_forms =
    R"({"x": m}, {"node": name, "component": name}, {"node": name, "direction": [3 numbers]}, )"
    R"({"dofs": [{"dof", "weight"}]} or {"point": name}; of bodies with "body": name)";
// What of a place says where it points: one at most of a position, one of a node unless a clearance stands there.
bool one_way(const Field& field, const Json& place) {
  const int ways = place.contains("component") + place.contains("direction");
  if (place.contains("x")) return ways <= 1;
  if (place.contains("node")) return ways == 1 || (ways == 0 && field.node_alone);
  return ways == 0;
}

Json check_plane_direction(const Json& value, const std::string& pointer) {
  if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number())
    throw InputError(pointer, "expected two numbers, along y and z, found " + quote(value));
  return {value[0].get<double>(), value[1].get<double>()};
}

void known_keys(const Json& object, const std::vector<std::string>& keys, const std::string& pointer) {
  for (const auto& [key, ignored] : object.items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw InputError(pointer_to(pointer, key), "unknown key \"" + shortened(key) + "\"" + did_you_mean(key, keys) +
                                                     " (keys here: " + quoted_list(keys) + ")");
}

double number_at(const Json& value, const std::string& pointer) {
  if (!value.is_number()) throw InputError(pointer, "expected a number, found " + quote(value));
  return value.get<double>();
}

std::string word_at(const Json& value, const std::string& pointer) {
  if (!value.is_string()) throw InputError(pointer, "expected a name, found " + quote(value));
  return value.get<std::string>();
}

Json check_dofs(const Json& list, const std::string& pointer) {
  if (!list.is_array() || list.empty())
    throw InputError(pointer, R"(expected a list of {"dof", "weight"}, found )" + quote(list));
  Json out = Json::array();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string here = pointer_to(pointer, i);
    if (!list[i].is_object()) throw InputError(here, R"(expected {"dof", "weight"}, found )" + quote(list[i]));
    known_keys(list[i], {"dof", "weight"}, here);
    const auto dof = list[i].find("dof");
    if (dof == list[i].end() || !dof->is_number_integer())
      throw InputError(pointer_to(here, "dof"), "expected a whole number, that of the dof in its table");
    const auto weight = list[i].find("weight");
    out.push_back(
        {{"dof", *dof}, {"weight", weight == list[i].end() ? 1.0 : number_at(*weight, pointer_to(here, "weight"))}});
  }
  return out;
}

}  // namespace

Json check_direction(const Json& value, const std::string& pointer) {
  if (!value.is_array() || value.size() != 3)
    throw InputError(pointer, "expected three numbers, found " + quote(value));
  Json out = Json::array();
  for (std::size_t i = 0; i < 3; ++i) out.push_back(number_at(value[i], pointer_to(pointer, i)));
  return out;
}

Json direction_schema() {
  return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
}

Json check_place(const Field& field, const Json& value, const std::string& pointer) {
  if (value.is_null() && field.nullable) return value;
  if (value.is_number() && field.plain) return value.get<double>();
  if (!value.is_object())
    throw InputError(pointer, std::string("expected ") + (field.plain ? "x in m, or a place: " : "a place: ") +
                                  place_forms + ", found " + quote(value));
  known_keys(value, {"x", "node", "component", "direction", "dofs", "point", "body"}, pointer);
  if (value.contains("body")) {
    Json own = value, out;
    own.erase("body");
    // That of an oscillator needs no more.
    if (!own.empty()) out = check_place(field, own, pointer);
    out["body"] = word_at(value["body"], pointer_to(pointer, "body"));
    return out;
  }
  const auto has = [&](const char* key) { return value.contains(key); };
  const int ways = has("x") + has("node") + has("dofs") + has("point");
  if (ways != 1 || !one_way(field, value))
    throw InputError(pointer, std::string("expected one of ") + place_forms + ", found " + quote(value));
  if (has("x")) {
    Json out = {{"x", number_at(value["x"], pointer_to(pointer, "x"))}};
    if (has("component")) out["component"] = word_at(value["component"], pointer_to(pointer, "component"));
    if (has("direction"))
      out["direction"] = check_plane_direction(value["direction"], pointer_to(pointer, "direction"));
    return out;
  }
  if (has("point")) return {{"point", word_at(value["point"], pointer_to(pointer, "point"))}};
  if (has("dofs")) return {{"dofs", check_dofs(value["dofs"], pointer_to(pointer, "dofs"))}};
  Json out = {{"node", word_at(value["node"], pointer_to(pointer, "node"))}};
  if (has("component")) {
    out["component"] = word_at(value["component"], pointer_to(pointer, "component"));
    return out;
  }
  if (!has("direction")) return out;
  out["direction"] = check_direction(value["direction"], pointer_to(pointer, "direction"));
  return out;
}

Json place_schema(const Field& field) {
  const Json number = {{"type", "number"}}, word = {{"type", "string"}};
  const Json dof = {{"type", "object"},
                    {"properties", {{"dof", {{"type", "integer"}, {"minimum", 1}}}, {"weight", number}}},
                    {"required", {"dof"}},
                    {"additionalProperties", false}};
  Json place = {{"properties",
                 {{"x", number},
                  {"node", word},
                  {"component", word},
                  {"direction", {{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 3}}},
                  {"dofs", {{"type", "array"}, {"items", dof}, {"minItems", 1}}},
                  {"point", word},
                  {"body", word}}},
                {"additionalProperties", false},
                {"anyOf", Json::array({{{"required", {"body"}}},
                                       {{"required", {"x"}}},
                                       {{"required", {"dofs"}}},
                                       {{"required", {"point"}}},
                                       {{"required", {"node", "component"}}},
                                       {{"required", {"node", "direction"}}}})}};
  if (field.node_alone) place["anyOf"].push_back({{"required", {"node"}}});
  Json types = {"object"};
  if (field.plain) types.push_back("number");
  if (field.nullable) types.push_back("null");
  return {{"type", types}, {"if", {{"type", "object"}}}, {"then", place}};
}

Json check_files(const Json& value, const std::string& pointer) {
  const auto is_text = [](const Json& one) { return one.is_string(); };
  if (value.is_null()) return value;
  if (!value.is_object() || !value.contains("folder") || !value["folder"].is_string() || !value.contains("digests") ||
      !value["digests"].is_object() || !std::all_of(value["digests"].begin(), value["digests"].end(), is_text))
    throw InputError(pointer, R"(expected {"folder": path, "digests": {file: digest}}, found )" + quote(value));
  return value;
}

Json check_named(const Field& field, const Json& value, const std::string& pointer) {
  if (!value.is_object()) throw InputError(pointer, R"(expected {"name": file, …}, found )" + quote(value));
  for (const auto& [name, text] : value.items())
    if (name.empty() || !text.is_string())
      throw InputError(pointer_to(pointer, name),
                       "expected a name and a text for " + field.key() + ", found " + quote(text));
  return value;
}

}  // namespace ricochet
