#include "runners/study/study_kind.hpp"

namespace ricochet {

const StudyKind* find_study_kind(const std::string& name) {
  for (const StudyKind* kind : study_kinds())
    if (kind->name == name) return kind;
  return nullptr;
}

Json given_settings(const Json& resolved, const std::vector<std::string>& keys) {
  Json settings = Json::object();
  for (const std::string& key : keys)
    if (const auto found = resolved.find(key); found != resolved.end() && !found->is_null()) settings[key] = *found;
  return settings.empty() ? Json(nullptr) : settings;
}

}  // namespace ricochet
