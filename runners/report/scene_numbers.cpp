#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>

#include "runners/report/html.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/declared_keys.hpp"

namespace ricochet::report {
namespace {

using Numbers = std::vector<SceneNumber>;

constexpr const char* name_key = "name";

/// Goes through what the form declares and says what stands there.
class SceneSpeaker {
 public:
  explicit SceneSpeaker(const Json& study) : study_(study), scene_(study) {}

  /// What one key says, where it says something.
  void add(const Field& field, const std::string& symbol, const std::string& pointer, Numbers& out) const {
    if (const std::string text = text_of(field, pointer); !text.empty()) out.push_back({symbol, text, pointer});
  }

  /// The keys of an object. `of`: " of rod" where several bodies have such an object.
  Numbers object(const ObjectForm& form, const Json& value, const std::string& pointer,
                 const std::string& of = "") const {
    Numbers out;
    std::vector<const Field*> fields;
    try {
      fields = fields_of(form, value, pointer);
    } catch (const InputError&) {
      return out;  // of another format
    }
    if (!form.at_rest.empty() && scene_.text(pointer_to(pointer, form.at_rest), "").empty()) return out;
    for (const Field* field : fields) {
      const std::string here = pointer_to(pointer, field->key()), symbol = symbol_of(*field) + of;
      if (field->key() == name_key) continue;  // stands before the object
      const auto found = value.find(field->key());
      const auto objects = found == value.end() ? std::vector<StandingObject>() : objects_at(*field, *found);
      if (objects.empty()) add(*field, symbol, here, out);
      for (const StandingObject& one : objects) add_object(*field, one, symbol, here, out);
    }
    if (const auto section = SceneValues(study_, pointer).section())
      for (const auto& [symbol, text] :
           {std::pair("EI", number_text(section->EI) + " N m²"), {"ρS", number_text(section->rhoS) + " kg/m"}})
        if (std::none_of(out.begin(), out.end(), [&, which = symbol](const auto& one) { return one.symbol == which; }))
          out.push_back({symbol, text, pointer + "/section"});
    return out;
  }

 private:
  static std::string symbol_of(const Field& field) { return field.symbol.value_or(in_words(field.key())); }

  void add_object(const Field& field, const StandingObject& one, const std::string& symbol, const std::string& pointer,
                  Numbers& out) const {
    const std::string here = one.step.empty() ? pointer : pointer_to(pointer, one.step);
    const bool by_body = field.form == Field::Form::object && !field.given.empty() && !one.step.empty();
    Numbers held = object(*one.form, *one.value, here, by_body ? " of " + one.step : "");
    const bool entry = !one.step.empty() && !by_body;
    // The symbol of what may be one object or a list is that of the list's entries.
    if (!entry && (!field.symbol || !field.listed.empty())) {
      out.insert(out.end(), held.begin(), held.end());
    } else if (entry) {
      const std::string name = one.value->is_object() ? one.value->value(name_key, "") : "";
      const std::string& called = field.form == Field::Form::bodies ? one.step : name;
      out.push_back({symbol + (called.empty() ? "" : " " + called), in_a_line(held), here, true});
    } else if (!held.empty()) {
      out.push_back({symbol, held.size() == 1 ? in_a_line(held) : "(" + in_a_line(held) + ")", here});
    }
  }

  /// "" for what is not there, null or at its default.
  std::string text_of(const Field& field, const std::string& pointer) const {
    using Form = Field::Form;
    const std::string unit = field.spec.unit == "1" ? "" : field.spec.unit;
    const Json* value = scene_.at(pointer);
    if (field.form == Form::place && value && value->is_object()) {
      const std::string x = pointer + "/x";
      return scene_.swept(x).empty() ? place_words(*value) : "x = " + scene_.said(x, unit);
    }
    // Where stops act is told of all.
    const bool at_default = value && field.fallback && is_same(*value, *field.fallback) && field.form != Form::places;
    if (at_default && scene_.swept(pointer).empty()) return "";
    if (field.form == Form::named && value && value->is_object()) {
      std::vector<std::string> words;
      for (const auto& [name, text] : value->items())
        words.push_back(name + " " + (text.is_string() ? text.get<std::string>() : text.dump()));
      return fmt::format("{}", fmt::join(words, ", "));
    }
    const std::string text = scene_.said(pointer, unit, field.axis && field.form != Form::places);
    return field.form == Form::place && !text.empty() ? "x = " + text : text;
  }

  /// A formula may be a number, one name a list.
  static bool is_same(const Json& value, const Json& fallback) {
    if (value.is_array() && value.size() == 1 && !fallback.is_array()) return is_same(value.front(), fallback);
    return value == fallback || (value == 0 && fallback == "0");
  }

  const Json& study_;
  SceneValues scene_;
};

}  // namespace

std::string in_a_line(const std::vector<SceneNumber>& numbers) {
  std::vector<std::string> words;
  for (const SceneNumber& one : numbers)
    words.push_back(one.symbol + (one.symbol.empty() ? "" : one.entry ? ": " : " ") + one.text);
  return fmt::format("{}", fmt::join(words, ", "));
}

std::vector<SceneNumber> scene_numbers(const nlohmann::ordered_json& study) {
  const SceneSpeaker speaker(study);
  Numbers out;
  if (const auto scene = study.find("scene"); scene != study.end())
    out = speaker.object(scene_form(), *scene, "/scene");
  if (const Field* duration = declared_at("/duration", study))
    speaker.add(*duration, duration->key(), "/duration", out);
  return out;
}

}  // namespace ricochet::report
