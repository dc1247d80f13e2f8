#include "runners/store/merge_environments.hpp"

#include <algorithm>

namespace ricochet {

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
