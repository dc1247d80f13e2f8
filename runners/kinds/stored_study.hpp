#pragma once
#include <atomic>
#include <filesystem>
#include <ricochet/contract/registry.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <vector>

#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// The study of one case alone, of its own kind. It has the case's methods and mesh, and its step where it has one;
/// every other key is as in the study. Axes of the scene stay lists, of one value: the case keeps its id and its
/// results. `minimal_study` makes a trajectory of it instead.
nlohmann::ordered_json single_study(const StudyResults& results, const CaseRecord& record);

/// The one case whose id begins so. Throws PointRefused with the nearest id or all of them.
const CaseRecord& find_case(const StudyResults& results, const std::string& id);

/// The study of stored results, parsed again, and the case of this id. Throws PointRefused where there is none any
/// more, PluginError where no plugin provides one of its methods.
struct StoredStudy {
  StoredStudy(const StudyResults& results, const std::vector<std::filesystem::path>& plugins);
  const StudyCase& find(const std::string& id) const;
  Catalogue catalogue;
  Registry registry;
  Study study;
};

class Kind;

/// The case of stored results in `folder` marched again, as a run of its study marches it: references that the store
/// keeps are not computed again. Throws Interrupted where `stop` became true.
CaseRecord march_again(const std::filesystem::path& folder, const Kind& kind, const StoredStudy& stored,
                       const StudyCase& study_case, const std::atomic<bool>& stop);

}  // namespace ricochet
