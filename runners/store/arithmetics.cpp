#include "runners/store/arithmetics.hpp"

#include <fmt/format.h>

#include <map>

namespace ricochet {

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

}  // namespace ricochet
