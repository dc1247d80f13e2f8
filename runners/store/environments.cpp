#include "runners/store/environments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace ricochet {

std::string environment_entry(const Environment& environment, const std::string& name) {
  const auto found = std::find_if(environment.entries.begin(), environment.entries.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == environment.entries.end() ? "" : found->second;
}

std::string without_place(const std::string& name, const std::string& value) {
  const std::size_t open = value.rfind('(');
  return name.starts_with("plugin ") && open != std::string::npos ? value.substr(open) : value;
}

void tell_arithmetics(StudyResults& results) {
  std::map<std::string, int> met;
  for (const CaseRecord& record : results.cases)
    if (!record.arithmetic.empty() && !record.partial && record.status != "refused") ++met[record.arithmetic];
  if (met.empty()) return;
  auto& entries = results.environment.entries;
  std::erase_if(entries, [](const auto& entry) { return entry.first.starts_with(kArithmetic); });
  if (met.size() == 1) {
    entries.emplace_back(kArithmetic, met.begin()->first);
    return;
  }
  std::vector<std::string> parts;
  for (const auto& [digest, cases] : met)
    parts.push_back(fmt::format("{} ({} case{})", digest, cases, cases == 1 ? "" : "s"));
  entries.emplace_back(kArithmetic,
                       fmt::format("{} that differ in last digits: {}", met.size(), fmt::join(parts, ", ")));
}

std::string motion_key(const std::string& arithmetic, const std::string& key) {
  return arithmetic.empty() ? key : arithmetic + "/" + key;
}

Environment merge_environments(const Environment& now, const Environment& earlier) {
  const std::string mark = " (earlier cases)";
  Environment merged = now;
  const auto has = [&](const std::pair<std::string, std::string>& entry) {
    return std::find(merged.entries.begin(), merged.entries.end(), entry) != merged.entries.end();
  };
  for (const auto& [name, value] : earlier.entries) {
    const std::pair<std::string, std::string> entry = {name.ends_with(mark) ? name : name + mark, value};
    if (name != kStarted && !has({name, value}) && !has(entry)) merged.entries.push_back(entry);
  }
  return merged;
}

}  // namespace ricochet
