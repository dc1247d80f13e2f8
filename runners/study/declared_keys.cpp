#include "runners/study/declared_keys.hpp"

#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <span>

#include "runners/study/body_keys.hpp"
#include "runners/study/check_object.hpp"

namespace ricochet {
namespace {

using Path = std::span<const std::string>;

std::vector<std::string> keys_of(const std::string& pointer) {
  std::vector<std::string> keys;
  for (std::size_t begin = 1; begin <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', begin), pointer.size());
    keys.push_back(pointer.substr(begin, end - begin));
    begin = end + 1;
  }
  return keys;
}

const Field* find_declared(const ObjectForm& form, const Json& value, Path path) {
  using Form = Field::Form;
  if (path.empty() || !value.is_object()) return nullptr;
  for (const Field* field : fields_of(form, value, "")) {
    if (field->key() != path[0]) continue;
    if (path.size() == 1) return field;
    const auto found = value.find(field->key());
    if (found == value.end()) return nullptr;
    for (const StandingObject& one : objects_at(*field, *found))
      if (one.step.empty() || one.step == path[1])
        return find_declared(*one.form, *one.value, path.subspan(one.step.empty() ? 1 : 2));
    const bool holds = field->form == Form::place || field->form == Form::places || field->form == Form::numbers;
    return holds && path.size() == 2 ? field : nullptr;
  }
  return nullptr;
}

// Of the forms that a study may have, the first whose key has words. Numbers and names of entries are passed over.
std::string find_words(const ObjectForm& form, Path path) {
  const auto below = [&](const std::vector<ObjectForm>& forms, std::size_t passed) {
    for (const ObjectForm& one : forms)
      if (const std::string words = find_words(one, path.subspan(passed)); !words.empty()) return words;
    return std::string();
  };
  for (const Field& field : form.fields) {
    if (field.key() != path[0]) continue;
    if (path.size() == 1) {
      if (!field.words.empty()) return field.words;
      continue;
    }
    for (const auto* forms : {&field.nested, &field.listed, &field.given})
      for (std::size_t passed = 1; passed <= 2 && passed < path.size(); ++passed)
        if (const std::string words = below(*forms, passed); !words.empty()) return words;
  }
  for (const Variant& variant : form.variants)
    if (const std::string words = find_words(variant.keys, path); !words.empty()) return words;
  return below(form.ways, 0);
}

}  // namespace

const ObjectForm& scene_form() {
  const auto& keys = study_form().fields;
  const auto scene = std::find_if(keys.begin(), keys.end(), [](const Field& field) { return field.key() == "scene"; });
  return scene->nested.front();
}

std::vector<StandingObject> objects_at(const Field& field, const Json& value) {
  using Form = Field::Form;
  std::vector<StandingObject> out;
  const auto each = [&](const ObjectForm& form) {
    for (const auto& [step, one] : value.items()) out.push_back({step, &form, &one});
    return out;
  };
  const bool is_object = field.form == Form::object;
  if (value.is_array()) {
    if (is_object && !field.listed.empty()) return each(field.listed.front());
    if (field.form == Form::objects || is_object_list(field, value)) return each(field.nested.front());
    return out;
  }
  if (!value.is_object()) return out;
  if (field.form == Form::bodies) return each(field.nested.front());
  if (!field.given.empty()) {
    if (!is_object) return {{"", &field.given.front(), &value}};
    if (by_body(value)) return each(field.given.front());
  }
  return is_object ? std::vector<StandingObject>{{"", &field.nested.front(), &value}} : out;
}

const Field* declared_at(const std::string& pointer, const Json& study) {
  const std::vector<std::string> keys = keys_of(pointer);
  const auto scene = study.find("scene");
  try {
    // A scene is the same in studies of every kind.
    return keys.size() > 1 && keys[0] == "scene" && scene != study.end()
               ? find_declared(scene_form(), *scene, Path(keys).subspan(1))
               : find_declared(study_form(), study, keys);
  } catch (const InputError&) {  // no study of this format
  } catch (const Json::exception&) {
  }
  return nullptr;
}

std::string words_at(const std::string& pointer) {
  const std::vector<std::string> keys = keys_of(pointer);
  return keys.empty() ? "" : find_words(study_form(), keys);
}

}  // namespace ricochet
