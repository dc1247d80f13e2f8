#include "runners/kinds/single_study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runners/kinds/trajectory/minimal_study.hpp"

namespace ricochet {

nlohmann::ordered_json single_study(const StudyResults& results, const CaseRecord& record) {
  nlohmann::ordered_json study = minimal_study(results, record);
  study["kind"] = results.kind;
  if (record.status == "done")
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
    if (!study.contains(key) && key != "exclude") study[key] = value;
  return study;
}

}  // namespace ricochet
