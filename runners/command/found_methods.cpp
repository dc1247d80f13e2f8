#include "runners/command/found_methods.hpp"

#include "runners/command/subcommand.hpp"
#include "runners/study/check_object.hpp"

namespace ricochet::checking {
namespace {

namespace fs = std::filesystem;

bool looks_like_a_file(const std::string& operand) {
  return operand.find('/') != std::string::npos || operand.ends_with(".so");
}

// The file alone, so that no other library of the same name stands before it.
FoundMethods in_library(const fs::path& file) {
  if (!fs::exists(file)) throw UsageError("there is no file " + file.string());
  FoundMethods found;
  Catalogue catalogue({}, {}, {file});
  for (const Provided& provided : catalogue.provided()) {
    catalogue.require(provided.role, provided.name, found.registry);
    found.methods.emplace_back(provided.role, provided.name);
  }
  return found;
}

}  // namespace

FoundMethods find_methods(const std::string& operand, const std::vector<fs::path>& plugins) {
  if (looks_like_a_file(operand)) return in_library(operand);
  FoundMethods found;
  Catalogue catalogue = Catalogue::standard(plugins);
  std::vector<std::string> names;
  for (const Role role : all_roles) {
    const std::vector<std::string> here = catalogue.names(role);
    names.insert(names.end(), here.begin(), here.end());
    if (catalogue.require(role, operand, found.registry)) found.methods.emplace_back(role, operand);
  }
  if (!found.methods.empty()) return found;
  for (const Role role : all_roles)
    if (const Unusable* file = catalogue.unusable_provider(role, operand))
      throw PluginError(file->file.string() + ": " + file->reason);
  throw UsageError("no method is called \"" + operand + "\"" + did_you_mean(operand, names) +
                   " (found: " + quoted_list(names) + "); a library is given by its file, with a '/' or ending in .so");
}

}  // namespace ricochet::checking
