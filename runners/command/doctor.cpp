#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <ricochet/loader/installed_folder.hpp>
#include <set>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/run/environment.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

void print_program(std::ostream& out) {
  TextTable table({"", ""});
  for (const auto& [name, value] : describe_environment({}).entries)
    if (name != "started") table.add({name, value});
  const fs::path data = installed_data();
  table.add({"pages, studies", data.empty() ? "not installed: those of the source tree" : data.string()});
  out << table.text() << "\n";
}

bool shadowed(const Catalogue& catalogue, const Provided& method) {
  const auto& all = catalogue.provided();
  const auto first = std::find_if(all.begin(), all.end(), [&](const Provided& other) {
    return other.role == method.role && other.name == method.name;
  });
  return first->file != method.file;
}

const std::string* trouble_with(const Catalogue& catalogue, const fs::path& file) {
  for (const Unusable& unusable : catalogue.unusable())
    if (unusable.file == file) return &unusable.reason;
  return nullptr;
}

// Each file once: what it provides, or why it cannot serve.
void print_files(const Catalogue& catalogue, const std::vector<fs::path>& files, std::ostream& out) {
  TextTable table({"file", "state", "provides"});
  for (const fs::path& file : files) {
    if (const std::string* reason = trouble_with(catalogue, file)) {
      table.add({file.filename().string(), "unusable", *reason});
      continue;
    }
    std::string provides;
    bool hidden = true;
    for (const Provided& method : catalogue.provided()) {
      if (method.file != file) continue;
      const bool behind = shadowed(catalogue, method);
      hidden = hidden && behind;
      provides += (provides.empty() ? "" : ", ") + std::string(role_name(method.role)) + " " + method.name +
                  (behind ? " (shadowed: an earlier file provides it)" : "");
    }
    table.add({file.filename().string(), hidden ? "shadowed" : "ok", provides});
  }
  out << table.text(2);
}

void print_plugins(const Catalogue& catalogue, const std::vector<fs::path>& extra, std::ostream& out) {
  std::set<fs::path> files;
  for (const Provided& method : catalogue.provided()) files.insert(method.file);
  for (const Unusable& unusable : catalogue.unusable()) files.insert(unusable.file);
  for (const fs::path& folder : catalogue.folders()) {
    std::error_code ignored;
    std::vector<fs::path> here;
    for (const fs::path& file : files)
      if (folder / file.filename() == file && std::find(extra.begin(), extra.end(), file) == extra.end())
        here.push_back(file);
    out << "plugins in " << folder.string() << (fs::is_directory(folder, ignored) ? "" : ": no such folder")
        << (here.empty() ? ": none" : "") << "\n";
    if (!here.empty()) print_files(catalogue, here, out);
  }
  if (!extra.empty()) {
    out << "plugins given with --plugin\n";
    print_files(catalogue, extra, out);
  }
}

}  // namespace

int command_doctor(const Arguments& arguments, std::ostream& out) {
  print_program(out);
  Catalogue catalogue = standard_catalogue(arguments.plugins);
  Registry registry;
  catalogue.open_all(registry);
  print_plugins(catalogue, arguments.plugins, out);
  bool complete = true;
  for (const Role role : all_roles)
    if (registry.names(role).empty()) {
      out << "\nno usable " << role_name(role) << " plugin: no study can run\n";
      complete = false;
    }
  if (!catalogue.unusable().empty()) out << "\n" << catalogue.unusable().size() << " plugin file(s) cannot serve\n";
  return catalogue.unusable().empty() && complete ? exit_done : exit_plugin;
}

}  // namespace ricochet
