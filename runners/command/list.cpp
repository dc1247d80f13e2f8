#include <ostream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/study/study_schema.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

std::vector<Role> roles_asked(const Arguments& arguments) {
  if (arguments.operands.empty()) return {all_roles.begin(), all_roles.end()};
  return {role_called(arguments.operands.front())};
}

}  // namespace

Role role_called(const std::string& word) {
  std::vector<std::string> names;
  for (const Role role : all_roles) {
    if (word == role_name(role)) return role;
    names.emplace_back(role_name(role));
  }
  throw UsageError("there is no role \"" + word + "\"" + did_you_mean(word, names) + " (roles: " + quoted_list(names) +
                   ")");
}

int command_list(const Arguments& arguments, std::ostream& out) {
  const std::vector<Role> roles = roles_asked(arguments);
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  // Only the libraries of the roles asked for are opened; one that fails is told, and the others are listed.
  std::vector<Unusable> failed;
  TextTable table({"role", "name", "summary", "file"});
  for (const Role role : roles)
    for (const std::string& name : catalogue.names(role)) {
      try {
        catalogue.require(role, name, registry);
        table.add({role_name(role), name, registry.manual(role, name)->summary, registry.file(role, name)});
      } catch (const PluginError& error) {
        table.add({role_name(role), name, std::string("cannot be used: ") + error.what(), ""});
        failed.push_back({name, error.what()});
      }
    }
  out << table.text();
  for (const Unusable& file : catalogue.unusable())
    out << "\ncannot serve: " << file.file.string() << ": " << file.reason << "\n";
  return failed.empty() ? exit_done : exit_plugin;
}

int command_schema(const Arguments& arguments, std::ostream& out) {
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  catalogue.open_all(registry);
  out << study_schema(registry).dump() << "\n";
  return exit_done;
}

}  // namespace ricochet
