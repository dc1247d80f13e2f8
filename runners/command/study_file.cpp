#include "runners/command/study_file.hpp"

#include <set>

#include "runners/plan_files/plan_file.hpp"
#include "runners/study/load_study.hpp"

namespace ricochet {

int with_study(const Arguments& arguments, const std::function<int(const OpenStudy&)>& use) {
  const std::filesystem::path file = arguments.operands.front();
  OpenStudy open{{}, standard_catalogue(arguments.plugins), {}};
  try {
    open.study = load_study(file, open.catalogue, open.registry);
    return use(open);
  } catch (const InputError& error) {
    throw StudyError(explain(error, file));
  }
}

std::vector<std::string> plugin_warnings(const OpenStudy& open) {
  std::set<std::pair<Role, std::string>> used;
  for (const StudyCase& study_case : open.study.cases) {
    used.insert({{Role::mass, study_case.mass.name},
                 {Role::contact, study_case.contact.name},
                 {Role::time, study_case.time.name}});
    for (const MethodChoice& reference : study_case.references) used.emplace(Role::reference, reference.name);
  }
  std::vector<std::string> warnings;
  for (const auto& [role, name] : used)
    for (const std::filesystem::path& file : open.catalogue.shadowed(role, name))
      warnings.push_back(std::string(role_name(role)) + " '" + name + "' of " + file.string() + " is shadowed by " +
                         open.catalogue.provider(role, name)->string());
  for (const std::filesystem::path& folder : open.catalogue.missing_folders())
    warnings.push_back("no such plugin folder: " + folder.string());
  return warnings;
}

}  // namespace ricochet
