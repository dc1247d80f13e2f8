#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <ostream>
#include <ricochet/loader/catalogue.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/check/checks.hpp"
#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"

namespace ricochet::checking {

/// What an operand of `ricochet check` names, opened and registered.
struct FoundMethods {
  Registry registry;
  std::vector<std::pair<Role, std::string>> methods;  ///< of registry, in the order in which they are checked
};

/// Everything that a library or a plan provides. Throws UsageError where there is no such file, PluginError where it
/// cannot serve, StudyError where a plan is none.
FoundMethods methods_of_file(const std::filesystem::path& file);
/// A method's name (every role that has it), or a file. `plugins`: further files to search. Throws UsageError where
/// nothing has the name, and what methods_of_file() throws.
FoundMethods find_methods(const std::string& operand, const std::vector<std::filesystem::path>& plugins);

namespace {

namespace fs = std::filesystem;

bool looks_like_a_file(const std::string& operand) {
  return operand.find('/') != std::string::npos || operand.ends_with(".so") || is_plan_file(operand);
}

void add_all(const Registry& registry, FoundMethods& found) {
  for (const Role role : all_roles)
    for (const std::string& name : registry.names(role)) found.methods.emplace_back(role, name);
}

}  // namespace

// The file alone, so that no other of the same name stands before it.
FoundMethods methods_of_file(const fs::path& file) {
  if (!fs::exists(file)) throw UsageError("there is no file " + file.string());
  FoundMethods found;
  if (is_plan_file(file)) {
    found.registry = registry_of_plan(file);
    add_all(found.registry, found);
    return found;
  }
  Catalogue catalogue({}, {}, {file});
  tell_remarks(catalogue);
  for (const Provided& provided : catalogue.provided()) catalogue.require(provided.role, provided.name, found.registry);
  add_all(found.registry, found);
  return found;
}

FoundMethods find_methods(const std::string& operand, const std::vector<fs::path>& plugins) {
  if (looks_like_a_file(operand)) return methods_of_file(operand);
  FoundMethods found;
  Catalogue catalogue = standard_catalogue(plugins);
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
                   " (found: " + quoted_list(names) + "); " + where_looked(catalogue) +
                   "; a file is given with a '/', or ends in .so (a library) or .json (a plan)");
}

}  // namespace ricochet::checking

namespace ricochet {
namespace {

using checking::CheckResult;
using checking::Finding;

std::vector<CheckResult> checked(const Registry& registry, Role role, const std::string& name) {
  checking::Isolation isolation;
  isolation.lasts = [&](const std::string& check) {
    constexpr int begun = 3;  // s before
    const auto end =
        std::chrono::system_clock::now() + std::chrono::seconds(static_cast<int>(isolation.seconds) - begun);
    std::cerr << fmt::format(
        "ricochet: {} {}: \"{}\" is still running; it is ended at {:%H:%M:%S}, {:g} s after it began\n",
        role_name(role), name, check, fmt::localtime(std::chrono::system_clock::to_time_t(end)), isolation.seconds);
  };
  switch (role) {
    case Role::mass:
      return checking::check_mass(*registry.mass(name), isolation);
    case Role::contact:
      return checking::check_law(*registry.contact(name), isolation);
    case Role::friction:
      return checking::check_friction(*registry.friction(name), isolation);
    case Role::time:
      return checking::check_scheme(*registry.time(name), isolation);
    case Role::reference:
      break;
  }
  return checking::check_reference(*registry.reference(name), isolation);
}

void print(const CheckResult& result, std::ostream& out) {
  constexpr std::size_t indent = 38;
  out << fmt::format("  {:<18}  {:<14}", result.check, word(result.finding));
  bool first = true;
  for (const std::string& sentence : result.sentences) {
    out << (first ? "  " : "\n" + std::string(indent, ' ')) << sentence;
    first = false;
  }
  out << "\n";
}

}  // namespace

int command_check(const Arguments& arguments, std::ostream& out) {
  std::vector<checking::FoundMethods> all;
  if (!arguments.operands.empty())
    all.push_back(checking::find_methods(arguments.operands.front(), arguments.plugins));
  else
    for (const auto& file : arguments.plugins) all.push_back(checking::methods_of_file(file));
  if (all.empty()) throw UsageError("expected the name of a method, a file, or --plugin FILE");
  int failed = 0, count = 0;
  for (const checking::FoundMethods& found : all)
    for (const auto& [role, name] : found.methods) {
      const std::string file = found.registry.file(role, name);
      out << role_name(role) << " " << name << (file.empty() ? "" : " (" + file + ")") << "\n" << std::flush;
      for (const CheckResult& result : checked(found.registry, role, name)) {
        print(result, out);
        ++count;
        if (result.finding == Finding::fails) ++failed;
      }
    }
  out << (failed == 0 ? fmt::format("{} checks, none fails\n", count)
                      : fmt::format("{} of {} checks fail\n", failed, count));
  return failed == 0 ? exit_done : exit_some_failed;
}

}  // namespace ricochet
