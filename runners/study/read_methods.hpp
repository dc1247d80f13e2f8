#pragma once
#include <filesystem>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// One method of one role, every list of parameters expanded.
struct MethodOption {
  MethodChoice choice;
  std::vector<std::pair<std::string, Json>> axes;  ///< "time": name, then "time.beta": value, …, in the plugin's order
  std::vector<std::string> places;                 ///< JSON pointers that chose it: the entry, then list elements
};

struct MethodOptions {
  std::vector<MethodOption> options;  ///< in the study's order
  Json resolved;                      ///< a list of complete objects
};

/// Reads the methods of a role: a name, an object {name, parameters…}, or a list of either. Opens the libraries named,
/// and only these. Throws InputError for an unknown name, parameter or value. Throws PluginError when the library that
/// provides the name fails, or the only file meant to provide it cannot serve. Also when the name is near no other, and
/// files were found that tell nothing of themselves. A scheme that the study states itself (plan_file.hpp) is
/// read relative to `folder`; its resolved object holds the plan.
MethodOptions read_methods(Role role, const Json& value, const std::string& pointer, Catalogue& catalogue,
                           Registry& registry, const std::filesystem::path& folder = {});

}  // namespace ricochet
