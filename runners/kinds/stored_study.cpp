#include "runners/kinds/stored_study.hpp"

#include <fmt/format.h>

#include <ricochet/contract/errors.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/report/html.hpp"
#include "runners/study/load_study.hpp"

namespace ricochet {
namespace {

constexpr std::size_t ids_told = 12;

}  // namespace

const CaseRecord& find_case(const StudyResults& results, const std::string& id) {
  std::vector<const CaseRecord*> found;
  std::vector<std::string> ids;
  for (const CaseRecord& record : results.cases) {
    if (record.id == id) return record;
    if (record.id.starts_with(id)) found.push_back(&record);
    ids.push_back(record.id);
  }
  if (found.size() == 1) return *found.front();
  std::vector<std::string> named;
  for (const CaseRecord* record : found) named.push_back(record->id);
  if (!found.empty())
    throw PointRefused(fmt::format("the case \"{}\" is one of {}", id, report::list_text(named, ids_told)));
  const std::string nearest = nearest_name(id, ids);
  throw PointRefused(fmt::format("there is no case \"{}\"{}; its cases are {}", id,
                                 nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?",
                                 report::list_text(ids, ids_told)));
}

StoredStudy::StoredStudy(const StudyResults& results, const std::vector<std::filesystem::path>& plugins)
    : catalogue(standard_catalogue(plugins)), study(parse_study(results.study.dump(), catalogue, registry)) {}

const StudyCase& StoredStudy::find(const std::string& id) const {
  if (const StudyCase* found = find_case(study, id)) return *found;
  throw PointRefused(fmt::format("the stored study has no case {} any more: run it again", id));
}

}  // namespace ricochet
