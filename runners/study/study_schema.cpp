#include "runners/study/study_schema.hpp"

#include <cmath>

#include "runners/study/field.hpp"
#include "runners/study/plan_schema.hpp"

namespace ricochet {
namespace {

const Json position_schema = {{"type", "number"}, {"exclusiveMinimum", 0}};

class SchemaWriter {
 public:
  explicit SchemaWriter(const Registry& registry) : registry_(registry) {}

  // One schema per way through the variants; more than one way: exactly one of them.
  Json object(const ObjectForm& form) {
    Json ways = Json::array();
    collect(form, {}, Json::array(), ways);
    if (ways.size() == 1) return ways.front();
    return {{"type", "object"}, {"oneOf", ways}};
  }

 private:
  void collect(const ObjectForm& form, std::vector<const Field*> fields, Json conditions, Json& ways) {
    for (const Field& field : form.fields) fields.push_back(&field);
    for (const ObjectForm& way : form.ways) collect(way, fields, conditions, ways);
    if (!form.ways.empty()) return;
    if (form.discriminator.empty()) {
      ways.push_back(closed(fields, conditions));
      return;
    }
    for (const Variant& variant : form.variants) {
      Json further = conditions;
      further.push_back(condition(form.discriminator, variant.words));
      collect(variant.keys, fields, std::move(further), ways);
    }
  }

  // That the word at `path` is one of `words`.
  static Json condition(const std::string& path, const std::vector<std::string>& words) {
    if (path.empty()) return {{"enum", words}};
    const auto end = std::min(path.find('/', 1), path.size());
    const std::string key = path.substr(1, end - 1);
    return {{"properties", {{key, condition(path.substr(end), words)}}}};
  }

  Json closed(const std::vector<const Field*>& fields, const Json& conditions) {
    Json properties = Json::object(), required = Json::array();
    for (const Field* field : fields) {
      properties[field->key()] = value(*field);
      if (field->required()) required.push_back(field->key());
    }
    Json schema = {{"type", "object"}, {"properties", properties}};
    if (!required.empty()) schema["required"] = required;
    schema["additionalProperties"] = false;
    if (!conditions.empty()) schema["allOf"] = conditions;
    return schema;
  }

  Json value(const Field& field) {
    Json schema = single(field);
    if (field.axis) {
      const Json list = {{"type", "array"}, {"items", schema}, {"minItems", 1}, {"uniqueItems", true}};
      schema = {{"anyOf", Json::array({schema, list})}};
    }
    std::string text = field.spec.text;
    if (!field.spec.unit.empty() && field.spec.unit != "1") text += " Unit: " + field.spec.unit + ".";
    Json described = {{"description", text}};
    if (field.fallback) described["default"] = *field.fallback;
    described.update(schema);
    return described;
  }

  Json single(const Field& field) {
    switch (field.form) {
      case Field::Form::scalar:
        if (field.nullable) return {{"anyOf", Json::array({scalar(field.spec), {{"type", "null"}}})}};
        return scalar(field.spec);
      case Field::Form::text:
        return {{"type", "string"}};
      case Field::Form::formula:
        return {
            {"type", field.nullable ? Json::array({"number", "string", "null"}) : Json::array({"number", "string"})}};
      case Field::Form::places:
        return {{"anyOf", Json::array({{{"enum", {"nodes", "tip"}}},
                                       {{"type", "array"}, {"items", position_schema}, {"minItems", 1}}})}};
      case Field::Form::object:
        if (field.nullable) return {{"anyOf", Json::array({object(field.nested.front()), {{"type", "null"}}})}};
        return object(field.nested.front());
      case Field::Form::objects:
        return {{"type", "array"},
                {"items", object(field.nested.front())},
                {"minItems", field.count},
                {"maxItems", field.count}};
      case Field::Form::numbers:
        return one_or_list(scalar(field.spec));
      case Field::Form::words: {
        const Json words = one_or_list(scalar(field.spec));
        return field.nullable ? Json{{"anyOf", Json::array({words, {{"type", "null"}}})}} : words;
      }
      case Field::Form::starts:
        return one_or_list({{"anyOf", Json::array({scalar(field.spec), object(field.nested.front())})}});
      case Field::Form::methods:
        return methods(field.role, field.marched);
      case Field::Form::excludes:
        break;
    }
    return excludes();
  }

  static Json one_or_list(const Json& one) {
    return {{"anyOf", Json::array({one, {{"type", "array"}, {"items", one}, {"minItems", 1}, {"uniqueItems", true}}})}};
  }

  static Json scalar(const ParameterSpec& spec) {
    switch (spec.type) {
      case ParameterSpec::Type::boolean:
        return {{"type", "boolean"}};
      case ParameterSpec::Type::word:
        return {{"enum", spec.words}};
      case ParameterSpec::Type::real:
      case ParameterSpec::Type::integer:
        break;
    }
    Json schema = {{"type", spec.type == ParameterSpec::Type::integer ? "integer" : "number"}};
    if (std::isfinite(spec.range.low)) schema[spec.range.low_open ? "exclusiveMinimum" : "minimum"] = spec.range.low;
    if (std::isfinite(spec.range.high)) schema[spec.range.high_open ? "exclusiveMaximum" : "maximum"] = spec.range.high;
    return schema;
  }

  Json methods(Role role, bool marched) {
    Json plain = Json::array(), ways = Json::array();
    if (marched) plain.push_back(marched_reference);
    for (const std::string& name : registry_.names(role)) {
      const PluginManual& manual = *registry_.manual(role, name);
      const ObjectForm form = method_form(manual);
      Json way = object(form);
      way["title"] = name;
      way["description"] = manual.summary + " " + manual.text;
      ways.push_back(std::move(way));
      bool complete = true;
      for (const ParameterSpec& spec : manual.parameters) complete = complete && spec.fallback.has_value();
      if (complete) plain.push_back(name);
    }
    if (role == Role::time) ways.push_back(stated_plan_schema());
    // A bare name stands for a method whose parameters all have defaults.
    if (!plain.empty()) ways.insert(ways.begin(), Json{{"enum", plain}});
    if (ways.empty()) ways.push_back({{"type", Json::array({"string", "object"})}});
    const Json one = {{"anyOf", ways}};
    return {{"anyOf", Json::array({one, {{"type", "array"}, {"items", one}, {"minItems", 1}}})}};
  }

  Json excludes() {
    const Json text = {{"type", "string"}, {"minLength", 1}, {"description", "The reason; the report shows it."}};
    Json properties = {
        {"why", text}, {"elements", Json::object()}, {"step", Json::object()}, {"steps_per_period", Json::object()}};
    for (const Role role : {Role::mass, Role::contact, Role::time}) {
      properties[role_name(role)] = {{"description", "Name of a method, or a list of names."}};
      for (const std::string& name : registry_.names(role))
        for (const ParameterSpec& spec : registry_.manual(role, name)->parameters)
          properties[std::string(role_name(role)) + "." + spec.key] = {{"description", spec.text}};
    }
    for (const Field& field : study_form().fields)
      if (field.key() == "scene") scene_axes(field.nested.front(), "", properties);
    const Json entry = {{"type", "object"},
                        {"properties", properties},
                        {"required", {"why"}},
                        {"minProperties", 2},
                        {"additionalProperties", false}};
    return {{"type", "array"}, {"items", entry}};
  }

  // Every scalar of the scene may be an axis, named by its path.
  static void scene_axes(const ObjectForm& form, const std::string& path, Json& properties) {
    for (const Field& field : form.fields) {
      const std::string here = path.empty() ? field.key() : path + "." + field.key();
      if (field.form == Field::Form::object)
        scene_axes(field.nested.front(), here, properties);
      else if (field.axis)
        properties[here] = {{"description", field.spec.text}};
    }
    for (const Variant& variant : form.variants) scene_axes(variant.keys, path, properties);
  }

  const Registry& registry_;
};

}  // namespace

Json study_schema(const Registry& registry) {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Ricochet study"}};
  schema.update(SchemaWriter(registry).object(study_form()));
  return schema;
}

}  // namespace ricochet
