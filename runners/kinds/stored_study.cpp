#include "runners/kinds/stored_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/contract/errors.hpp>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/report/html.hpp"
#include "runners/store/store.hpp"
#include "runners/study/case_id.hpp"
#include "runners/study/load_study.hpp"
#include "runners/study/product.hpp"

namespace ricochet {

nlohmann::ordered_json single_study(const StudyResults& results, const CaseRecord& record) {
  nlohmann::ordered_json study = minimal_study(results, record);
  study["kind"] = results.kind;
  if (record.status == Status::done)
    study["question"] = fmt::format("The case {} of {} alone. {}", record.id, results.name, results.question);
  if (study["step"].is_null()) study.erase("step");
  for (const auto& [name, value] : record.axes) {
    const std::string role = name.substr(0, name.find('.'));
    if (name == "steps_per_period" || name == "march") {
      study[name] = value;
    } else if (name != "elements" && name != "step" && !study["methods"].contains(role)) {
      // An axis of the scene stays one: the case keeps its id.
      std::string place = "/" + name;
      std::replace(place.begin(), place.end(), '.', '/');
      study["scene"][nlohmann::ordered_json::json_pointer(place)] = nlohmann::ordered_json::array({value});
    } else if (value == "swept") {
      // The parameter is one of the method's: the study has a number there, which it replaces.
      const std::string key = name.substr(role.size() + 1);
      for (const auto& method : results.study.at("methods").at(role))
        if (method.at("name") == study["methods"][role].at("name") && method.contains(key))
          study["methods"][role][key] = method[key];
    }
  }
  study["scene"].erase("steps_per_period");
  for (const auto& [key, value] : results.study.items())
    // What was asked of all cases is not asked of one.
    if (!study.contains(key) && key != "exclude" && key != "ask") study[key] = value;
  return study;
}

namespace {

constexpr std::size_t ids_told = 12;

// What is only drawn beside the cases may be gone.
std::string text_to_compute(nlohmann::ordered_json study) {
  study.erase("beneath");
  return study.dump();
}

// Its methods were there when it ran: a name that is unknown is no slip.
Study study_to_compute(const StudyResults& results, Catalogue& catalogue, Registry& registry) {
  try {
    return parse_study(text_to_compute(results.study), catalogue, registry);
  } catch (const MissingMethod& error) {
    throw PluginError("at " + error.pointer() + ": " + error.what());
  }
}

}  // namespace

const CaseRecord& find_case(const StudyResults& results, const std::string& id) {
  std::vector<const CaseRecord*> found;
  std::vector<std::string> ids;
  for (const CaseRecord& record : results.cases) {
    if (record.id == id_of_today(id)) return record;
    if (begins_id(record.id, id)) found.push_back(&record);
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
    : catalogue(standard_catalogue(plugins)), study(study_to_compute(results, catalogue, registry)) {}

const StudyCase& StoredStudy::find(const std::string& id) const {
  if (const StudyCase* found = find_case(study, id)) return *found;
  throw PointRefused(fmt::format("the stored study has no case {} any more: run it again", id));
}

CaseRecord march_again(const std::filesystem::path& folder, const Kind& kind, const StoredStudy& stored,
                       const StudyCase& study_case, const std::atomic<bool>& stop) {
  const RunContext context{stored.study, stored.registry, [](const StudyCase& one) { return one.id; }};
  const CaseRunner runner = kind.start(context);
  CheckpointStore checkpoints;
  checkpoints.find = [&](const std::string& key) { return read_motion(folder, key, arithmetic_digest()); };
  if (runner.open) runner.open(checkpoints, stop);
  return runner.run(study_case, stop);
}

}  // namespace ricochet
