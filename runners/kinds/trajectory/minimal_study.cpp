#include "runners/kinds/trajectory/minimal_study.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> roles = {"mass", "contact", "time"};

// "support.amplitude" → "/support/amplitude".
Json::json_pointer scene_pointer(std::string column) {
  std::replace(column.begin(), column.end(), '.', '/');
  return Json::json_pointer("/" + column);
}

}  // namespace

Json minimal_study(const StudyResults& results, const CaseRecord& record) {
  Json scene = results.study.at("scene"), methods = Json::object();
  for (const std::string& role : roles) methods[role] = Json::object();
  Json elements = 1, step, march;
  for (const auto& [column, value] : record.axes) {
    const std::string role = column.substr(0, column.find('.'));
    if (column == "elements")
      elements = value;
    else if (column == "step")
      step = value;
    else if (column == "march")
      march = value;
    else if (std::find(roles.begin(), roles.end(), role) != roles.end())
      methods[role][column == role ? "name" : column.substr(role.size() + 1)] = value;
    else
      scene[scene_pointer(column)] = value;
  }
  // A scheme that the study states itself goes along.
  const Json::json_pointer times("/methods/time");
  if (results.study.contains(times) && results.study.at(times).is_array())
    for (const Json& method : results.study.at(times))
      if (method.is_object() && method.contains("plan") && method.at("name") == methods["time"].value("name", ""))
        methods["time"]["plan"] = method.at("plan");
  Json study = {
      {"name", fmt::format("{}-{}", results.name, record.id)},
      {"question", fmt::format("Why did this case of {} end as {}? {}", results.name, record.status, record.reason)},
      {"kind", "trajectory"},
      {"scene", scene},
      {"mesh", {{"elements", elements}}},
      {"methods", methods},
      {"step", step}};
  for (const char* key : {"duration", "samples", "window", "snapshots", "budget"})
    if (const auto found = results.study.find(key); found != results.study.end() && !found->is_null())
      study[key] = *found;
  if (!march.is_null()) study["march"] = march;
  return study;
}

}  // namespace ricochet
