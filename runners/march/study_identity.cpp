#include "runners/march/study_identity.hpp"

namespace ricochet {

std::vector<std::filesystem::path> libraries_of(const StudyCase& study_case, const Registry& registry) {
  return {registry.file(Role::mass, study_case.mass.name), registry.file(Role::contact, study_case.contact.name),
          registry.file(Role::time, study_case.time.name)};
}

std::string StudyIdentity::of(const StudyCase& study_case) {
  return fingerprints_.of(study_case, libraries_of(study_case, registry_));
}

std::string StudyIdentity::of_all() {
  std::string all;
  for (const StudyCase& one : study_.cases) all += of(one);
  return content_hash(all);
}

}  // namespace ricochet
