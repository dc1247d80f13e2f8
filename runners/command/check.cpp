#include <fmt/format.h>

#include <filesystem>
#include <ostream>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/check/checks.hpp"
#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"

namespace ricochet::checking {

/// What an operand of `ricochet check` names, opened and registered.
struct FoundMethods {
  Registry registry;
  std::vector<std::pair<Role, std::string>> methods;  ///< of registry, in the order in which they are checked
};

/// A method's name (every role that has it), or a library file (everything that it provides). `plugins`: further files
/// to search. Throws UsageError where nothing has the name, PluginError where what provides it cannot serve.
FoundMethods find_methods(const std::string& operand, const std::vector<std::filesystem::path>& plugins);

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

namespace ricochet {
namespace {

using checking::CheckResult;
using checking::Finding;

std::vector<CheckResult> checked(const Registry& registry, Role role, const std::string& name) {
  const checking::Isolation isolation;
  switch (role) {
    case Role::mass:
      return checking::check_mass(*registry.mass(name), isolation);
    case Role::contact:
      return checking::check_law(*registry.contact(name), isolation);
    case Role::time:
      return checking::check_scheme(*registry.time(name), isolation);
    case Role::reference:
      break;
  }
  return checking::check_reference(*registry.reference(name), isolation);
}

void print(const CheckResult& result, std::ostream& out) {
  constexpr std::size_t indent = 38;
  out << fmt::format("  {:<18}  {:<14}", result.check, checking::finding_word(result.finding));
  bool first = true;
  for (const std::string& sentence : result.sentences) {
    out << (first ? "  " : "\n" + std::string(indent, ' ')) << sentence;
    first = false;
  }
  out << "\n";
}

}  // namespace

int command_check(const Arguments& arguments, std::ostream& out) {
  const checking::FoundMethods found = checking::find_methods(arguments.operands.front(), arguments.plugins);
  int failed = 0, all = 0;
  for (const auto& [role, name] : found.methods) {
    const std::string file = found.registry.file(role, name);
    out << role_name(role) << " " << name << (file.empty() ? "" : " (" + file + ")") << "\n" << std::flush;
    for (const CheckResult& result : checked(found.registry, role, name)) {
      print(result, out);
      ++all;
      if (result.finding == Finding::fails) ++failed;
    }
  }
  out << (failed == 0 ? fmt::format("{} checks, none fails\n", all)
                      : fmt::format("{} of {} checks fail\n", failed, all));
  return failed == 0 ? exit_done : exit_some_failed;
}

}  // namespace ricochet
