#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "runners/plan_files/plan_file.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/fields.hpp"
#include "runners/study/load_study.hpp"
#include "runners/study/study.hpp"

namespace ricochet {
namespace {

const Json position_schema = {{"type", "number"}, {"exclusiveMinimum", 0}};

class SchemaWriter {
 public:
  explicit SchemaWriter(const Registry& registry) : registry_(registry) {}

  // Every key that some form of the object has is known here: a misspelt one is the first thing a validator tells.
  // Conditions on the discriminator say which of them belong together.
  Json object(const ObjectForm& form) {
    Json properties = Json::object(), required = Json::array();
    add_fields(form, properties, required);
    for (const std::string& key : keys_of(form))
      if (!properties.contains(key)) properties[key] = true;
    Json schema = {{"type", "object"}, {"additionalProperties", false}, {"patternProperties", remarks()}};
    schema["properties"] = std::move(properties);
    if (!required.empty()) schema["required"] = std::move(required);
    add_conditions(form, schema);
    return schema;
  }

  /// What is referred to by "#/$defs/NAME".
  Json definitions() { return std::move(definitions_); }

 private:
  // Short, as it stands in every object; which keys may begin so, the reader says.
  static Json remarks() { return {{"^[/$]", true}}; }
  static Json reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }
  static Json either(const char* type, Json then, Json otherwise) {
    return {{"if", {{"type", type}}}, {"then", std::move(then)}, {"else", std::move(otherwise)}};
  }

  /// What stands in many places, once: a reference to it. Beside a reference, a validator may ignore what else is said.
  Json shared(const std::string& what, const Json& schema) {
    int number = 1;
    std::string name;
    for (; definitions_.contains(name = fmt::format("{}-{}", what, number)); ++number)
      if (definitions_[name] == schema) break;
    definitions_[name] = schema;
    return {{"allOf", Json::array({reference(name)})}};
  }

  void add_fields(const ObjectForm& form, Json& properties, Json& required) {
    for (const Field& field : form.fields) {
      properties[field.key()] = value(field);
      if (field.required() && field.unless.empty()) required.push_back(field.key());
    }
  }

  /// Of the form and of all that it may become.
  static std::set<std::string> keys_of(const ObjectForm& form) {
    std::set<std::string> keys;
    for (const Field& field : form.fields) keys.insert(field.key());
    for (const Variant& variant : form.variants) keys.merge(keys_of(variant.keys));
    for (const ObjectForm& way : form.ways) keys.merge(keys_of(way));
    return keys;
  }

  /// What an object is in one of several forms: it has these keys, and none of the others'.
  Json one_of(const ObjectForm& form, const std::set<std::string>& of_all) {
    Json properties = Json::object(), required = Json::array();
    add_fields(form, properties, required);
    const std::set<std::string> own = keys_of(form);
    for (const std::string& key : of_all)
      if (own.count(key) == 0) properties[key] = false;
    Json schema = Json::object();
    if (!properties.empty()) schema["properties"] = std::move(properties);
    if (!required.empty()) schema["required"] = std::move(required);
    add_conditions(form, schema);
    return schema;
  }

  void add_conditions(const ObjectForm& form, Json& schema) {
    for (const Field& field : form.fields)
      if (!field.unless.empty())
        schema["oneOf"] = Json::array({{{"required", {field.key()}}}, {{"required", {field.unless}}}});
    std::set<std::string> of_all;
    for (const Variant& variant : form.variants) of_all.merge(keys_of(variant.keys));
    for (const ObjectForm& way : form.ways) of_all.merge(keys_of(way));
    for (const Variant& variant : form.variants)
      schema["allOf"].push_back(
          {{"if", condition(form.discriminator, variant.words)}, {"then", one_of(variant.keys, of_all)}});
    for (const ObjectForm& way : form.ways) schema["oneOf"].push_back(one_of(way, of_all));
  }

  // That there is a word at `path`, and that it is one of `words`.
  static Json condition(const std::string& path, const std::vector<std::string>& words) {
    if (path.empty()) return {{"enum", words}};
    const auto end = std::min(path.find('/', 1), path.size());
    const std::string key = path.substr(1, end - 1);
    return {{"properties", {{key, condition(path.substr(end), words)}}}, {"required", {key}}};
  }

  Json value(const Field& field) {
    Json schema = single(field);
    if (field.axis) {
      // A list of positions is one value of "at", and also looks like a list of values,
      const Json list = {{"type", "array"}, {"items", schema}, {"minItems", 1}, {"uniqueItems", true}};
      // and so do a list of objects of "load" and one of rows.
      const bool listed =
          field.form == Field::Form::places || !field.nested.empty() || field.spec.type == ParameterSpec::Type::table;
      schema = listed ? Json{{"anyOf", Json::array({schema, list})}} : shared("a", value_or_list(schema, list));
    }
    std::string text = field.spec.text;
    if (!field.spec.unit.empty() && field.spec.unit != "1") text += " Unit: " + field.spec.unit + ".";
    Json described = {{"description", text}};
    if (field.fallback)
      described["default"] = field.fallback->is_number() ? bound(field.fallback->get<double>()) : *field.fallback;
    described.update(schema);
    return described;
  }

  Json single(const Field& field) {
    switch (field.form) {
      case Field::Form::bodies:
        return {{"type", "object"}, {"additionalProperties", object(field.nested.front())}, {"minProperties", 1}};
      case Field::Form::scalar:
        if (field.per_body)
          return either("object", {{"additionalProperties", scalar(field.spec)}}, or_null(field, scalar(field.spec)));
        if (!field.given.empty())
          return or_null(field, either("object", object(field.given.front()), scalar(field.spec)));
        if (field.or_flag) return either("boolean", Json::object(), scalar(field.spec));
        return or_null(field, scalar(field.spec));
      case Field::Form::text:
        if (!field.given.empty()) return either("object", object(field.given.front()), {{"type", "string"}});
        return {{"type", "string"}};
      case Field::Form::formula:
        return formula(field);
      case Field::Form::places:
        return {{"anyOf", Json::array({{{"enum", {"nodes", "tip"}}},
                                       {{"type", "array"}, {"items", position_schema}, {"minItems", 1}}})}};
      case Field::Form::place:
        return place_schema(field);
      case Field::Form::named:
        return {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}};
      case Field::Form::files:
        return {{"type", Json::array({"object", "null"})}};
      case Field::Form::object:
        if (!field.listed.empty()) {
          Json items{{"items", object(field.listed.front())}};
          if (field.at_most != 0) items["maxItems"] = field.at_most;
          return or_null(field, either("array", items, object(field.nested.front())));
        }
        if (!field.given.empty())
          return {{"anyOf", Json::array({object(field.nested.front()),
                                         {{"type", "object"},
                                          {"additionalProperties", object(field.given.front())},
                                          {"minProperties", 1}}})}};
        return or_null(field, object(field.nested.front()));
      case Field::Form::objects:
        if (field.at_most != 0)
          return {{"type", "array"}, {"items", object(field.nested.front())}, {"maxItems", field.at_most}};
        if (field.count == 0) return {{"type", "array"}, {"items", object(field.nested.front())}};
        return {{"type", "array"},
                {"items", object(field.nested.front())},
                {"minItems", field.count},
                {"maxItems", field.count}};
      case Field::Form::numbers:
        return field.count == 3 ? direction_schema() : one_or_list(scalar(field.spec), !field.repeats);
      case Field::Form::words:
        return or_null(field, one_or_list(words(field)));
      case Field::Form::starts:
        return one_or_list(either("object", object(field.nested.front()), scalar(field.spec)));
      case Field::Form::share:
        return {{"anyOf", Json::array({{{"type", "number"}, {"exclusiveMinimum", 0}, {"maximum", 1}},
                                       {{"type", "string"}, {"pattern", "^[0-9.eE+-]+ *%$"}}})}};
      case Field::Form::levels:
        return {{"type", "object"},
                {"additionalProperties", {{"type", Json::array({"number", "string", "boolean"})}}},
                {"minProperties", 1}};
      case Field::Form::methods:
        return methods(field.role, field.marched);
      case Field::Form::excludes:
        break;
    }
    return excludes();
  }

  Json formula(const Field& field) {
    Json types = {"number", "string"};
    if (field.nullable) types.push_back("null");
    Json one = {{"type", types}};
    if (!field.given.empty()) one = either("object", object(field.given.front()), one);
    if (field.nested.empty()) return one;
    return either("array", {{"items", object(field.nested.front())}, {"minItems", 1}}, one);
  }

  /// Bounds speak of numbers alone and `items` of lists alone: where a type is named, one schema says both.
  static Json value_or_list(const Json& one, const Json& list) {
    if (!one.contains("type")) return either("array", list, one);
    Json both = one, types = one["type"].is_array() ? one["type"] : Json::array({one["type"]});
    types.push_back("array");
    both.update(list);
    both["type"] = std::move(types);
    return both;
  }

  static Json or_null(const Field& field, Json schema) {
    return field.nullable ? either("null", true, std::move(schema)) : schema;
  }

  /// `choices`: none stands twice; a list of numbers that is one value may repeat them.
  static Json one_or_list(const Json& one, bool choices = true) {
    Json list{{"items", one}, {"minItems", 1}};
    if (choices) list["uniqueItems"] = true;
    return either("array", list, one);
  }

  static Json bound(double value) {
    constexpr double largest = 1e15;
    return std::floor(value) == value && std::abs(value) < largest ? Json(static_cast<long long>(value)) : Json(value);
  }

  static Json words(const Field& field) {
    if (field.of_each.empty()) return scalar(field.spec);
    return {{"anyOf", Json::array({scalar(field.spec),
                                   {{"type", "string"},
                                    {"pattern", fmt::format("^({})\\[.+\\]$", fmt::join(field.of_each, "|"))}}})}};
  }

  static Json scalar(const ParameterSpec& spec) {
    switch (spec.type) {
      case ParameterSpec::Type::boolean:
        return {{"type", "boolean"}};
      case ParameterSpec::Type::word:
        return spec.words.empty() ? Json{{"type", "string"}} : Json{{"enum", spec.words}};
      case ParameterSpec::Type::table:
        return {
            {"type", "array"},
            {"minItems", 2},
            {"items",
             {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", {{"type", "number"}, {"minimum", 0}}}}}};
      case ParameterSpec::Type::real:
      case ParameterSpec::Type::integer:
        break;
    }
    Json schema = {{"type", spec.type == ParameterSpec::Type::integer ? "integer" : "number"}};
    if (std::isfinite(spec.range.low))
      schema[spec.range.low_open ? "exclusiveMinimum" : "minimum"] = bound(spec.range.low);
    if (std::isfinite(spec.range.high))
      schema[spec.range.high_open ? "exclusiveMaximum" : "maximum"] = bound(spec.range.high);
    return schema;
  }

  Json methods(Role role, bool marched) {
    const std::string role_word = role_name(role);
    if (!definitions_.contains(role_word)) define_method(role, marched);
    return either("array", {{"items", reference(role_word)}, {"minItems", 1}}, reference(role_word));
  }

  /// One method of a role: a bare name, where its parameters all have defaults, or an object.
  void define_method(Role role, bool marched) {
    const std::string role_word = role_name(role);
    Json plain = Json::array(), by_name = Json::array();
    if (marched) plain.push_back(marched_reference);
    for (const std::string& name : registry_.names(role)) {
      const PluginManual& manual = *registry_.manual(role, name);
      Json method = object(method_form(manual));
      // What the condition has said already.
      method.erase("type");
      if (method["required"].size() == 1) method.erase("required");
      method["properties"]["name"] = {{"description", manual.summary}};
      by_name.push_back({{"if", {{"properties", {{"name", {{"enum", {name}}}}}}}}, {"then", std::move(method)}});
      bool complete = true;
      for (const ParameterSpec& spec : manual.parameters) complete = complete && spec.fallback.has_value();
      if (complete) plain.push_back(name);
    }
    if (by_name.empty()) {
      definitions_[role_word] = {{"type", Json::array({"string", "object"})}};
      return;
    }
    Json object = condition("/name", registry_.names(role));
    object["allOf"] = std::move(by_name);
    if (role == Role::time) {
      const StatedPlanSchema stated = stated_plan_schema();
      definitions_.update(stated.definitions);
      object = {{"if", {{"required", {"plan"}}}}, {"then", stated.here}, {"else", std::move(object)}};
      object = {{"if", {{"required", {"file"}}}}, {"then", stated.in_file}, {"else", std::move(object)}};
    }
    definitions_[role_word] =
        either("object", std::move(object), plain.empty() ? Json{{"type", "object"}} : Json{{"enum", plain}});
  }

  Json excludes() {
    Json properties = {
        {"why", {{"type", "string"}, {"minLength", 1}, {"description", "The reason; the report shows it."}}},
        {"elements", true},
        {"modes", true},
        {residual_axis, true},
        {"step", true},
        {"steps_per_period", true},
        {"march", true}};
    for (const Role role : marched_roles) {
      properties[role_name(role)] = {{"description", "Name of a method, or a list of names."}};
      for (const std::string& name : registry_.names(role))
        for (const ParameterSpec& spec : registry_.manual(role, name)->parameters)
          properties[std::string(role_name(role)) + "." + spec.key] = true;
    }
    for (const Field& field : study_form().fields)
      if (field.key() == "scene") scene_axes(field.nested.front(), "", properties);
    // Numbers of objects in lists: "structure.supports.1.stiffness".
    Json patterns = remarks();
    patterns["^structure[.][a-z]+[.][0-9]+[.]"] = true;
    const Json entry = {{"type", "object"},   {"additionalProperties", false}, {"patternProperties", patterns},
                        {"minProperties", 2}, {"properties", properties},      {"required", {"why"}}};
    return {{"type", "array"}, {"items", entry}};
  }

  // Every scalar of the scene may be an axis, named by its path.
  static void scene_axes(const ObjectForm& form, const std::string& path, Json& properties) {
    for (const Field& field : form.fields) {
      const std::string here = path.empty() ? field.key() : path + "." + field.key();
      if (field.form == Field::Form::object)
        scene_axes(field.nested.front(), here, properties);
      else if (field.axis)
        properties[here] = true;
    }
    for (const Variant& variant : form.variants) scene_axes(variant.keys, path, properties);
  }

  const Registry& registry_;
  Json definitions_ = Json::object();
};

using SeeSchema = std::function<void(Json& schema, const std::string& key)>;

/// Every schema inside of a schema, outer ones first, with the key whose values it describes.
void each_schema(Json& schema, const std::string& key, const SeeSchema& see) {
  if (!schema.is_object()) return;
  see(schema, key);
  for (const char* keyed : {"properties", "$defs"})
    if (schema.contains(keyed))
      for (const auto& member : schema[keyed].items()) each_schema(member.value(), member.key(), see);
  for (const char* one : {"items", "if", "then", "else", "additionalProperties"})
    if (schema.contains(one)) each_schema(schema[one], key, see);
  for (const char* list : {"allOf", "anyOf", "oneOf"})
    if (schema.contains(list))
      for (Json& one : schema[list]) each_schema(one, key, see);
}

/// Schemas that stand in several places stand in $defs once: an editor reads a schema at every key.
void share_repeated(Json& schema) {
  std::map<std::string, int> counts;
  each_schema(schema, "", [&](Json& one, const std::string&) { ++counts[one.dump()]; });
  std::map<std::string, std::string> names;
  Json definitions = Json::object();
  each_schema(schema, "", [&](Json& one, const std::string& key) {
    const std::string text = one.dump();
    auto known = names.find(text);
    if (known == names.end()) {
      const std::string name = fmt::format("{}-{}", key, names.size() + 1);
      const std::size_t count = static_cast<std::size_t>(counts[text]), reference = name.size() + 18;
      if (count * text.size() <= count * reference + text.size() + name.size() + 4) return;
      known = names.emplace(text, name).first;
      definitions[known->second] = one;
    }
    one = {{"$ref", "#/$defs/" + known->second}};
  });
  schema["$defs"].update(definitions);
}

}  // namespace

Json study_schema(const Registry& registry) {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Ricochet study"}};
  SchemaWriter writer(registry);
  schema.update(writer.object(study_form()));
  schema["$defs"] = writer.definitions();
  share_repeated(schema);
  return schema;
}

}  // namespace ricochet
