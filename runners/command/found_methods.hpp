#pragma once
#include <filesystem>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ricochet::checking {

/// What an operand of `ricochet check` names, opened and registered.
struct FoundMethods {
  Registry registry;
  std::vector<std::pair<Role, std::string>> methods;  ///< of registry, in the order in which they are checked
};

/// A method's name (every role that has it), or a library file (everything that it provides). `plugins`: further files
/// to search. Throws UsageError where nothing has the name, PluginError where what provides it cannot serve.
FoundMethods find_methods(const std::string& operand, const std::vector<std::filesystem::path>& plugins);

}  // namespace ricochet::checking
