#include "runners/command/study_file.hpp"

#include "runners/study/load_study.hpp"
#include "runners/study/stated_plan.hpp"

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

}  // namespace ricochet
