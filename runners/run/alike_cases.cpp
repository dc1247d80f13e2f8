#include "runners/run/alike_cases.hpp"

#include <fmt/format.h>

#include "runners/store/fingerprint.hpp"

namespace ricochet {
namespace {

void add_form(const Json& value, std::string& text) {
  if (value.is_number()) {
    text += value.get<double>() == 0 ? "0" : "1";
  } else if (value.is_string()) {
    text += '"' + value.get_ref<const std::string&>() + '"';
  } else if (value.is_structured()) {
    text += value.is_object() ? '{' : '[';
    for (const Json& one : value) {
      add_form(one, text);
      text += ',';
    }
    text += value.is_object() ? '}' : ']';
  } else {
    text += value.dump();
  }
}

std::string text_of(const MethodChoice& method) {
  return content_of(method).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string cost_key(const StudyCase& study_case) {
  // The keys of a scene are complete and in one order: its values tell it.
  std::string key;
  add_form(study_case.scene_json, key);
  for (const MethodChoice* method : {&study_case.mass, &study_case.contact, &study_case.time}) key += text_of(*method);
  for (const MethodChoice& reference : study_case.references) key += text_of(reference);
  return key +
         fmt::format("{}/{}/{}/{}/{}/{}/", study_case.elements, study_case.step, study_case.steps_per_period,
                     study_case.duration, study_case.samples, study_case.march) +
         study_case.settings.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ricochet
