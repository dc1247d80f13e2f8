#include "runners/store/environment_entries.hpp"

#include <algorithm>

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

}  // namespace ricochet
