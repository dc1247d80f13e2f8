#include <algorithm>
#include <cstdlib>
#include <ricochet/contract/abi.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/loader/child.hpp>
#include <ricochet/loader/installed_folder.hpp>
#include <ricochet/loader/library.hpp>
#include <sstream>

namespace ricochet {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view provides_prefix = "ricochet_provides__";
constexpr std::string_view abi_prefix = "ricochet_abi__";
constexpr std::string_view layout_prefix = "ricochet_layout__";
constexpr std::string_view own_symbol = "ricochet_own";

std::optional<std::pair<Role, std::string>> parse_provides(std::string_view symbol) {
  symbol.remove_prefix(provides_prefix.size());
  for (const Role role : all_roles) {
    const std::string prefix = std::string(role_name(role)) + "__";
    if (!symbol.starts_with(prefix)) continue;
    std::string name(symbol.substr(prefix.size()));
    std::replace(name.begin(), name.end(), '_', '-');
    return std::pair(role, name);
  }
  return std::nullopt;
}

using Methods = std::vector<std::pair<Role, std::string>>;

// "time-leap-frog.so" is meant to provide the time scheme leap-frog.
Methods meant_by_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  for (const Role role : all_roles) {
    const std::string prefix = std::string(role_name(role)) + "-";
    if (stem.size() > prefix.size() && stem.starts_with(prefix)) return {{role, stem.substr(prefix.size())}};
  }
  return {};
}

std::string text(Role role, const std::string& name) {
  return std::string(role_name(role)) + " '" + name + "'";
}

}  // namespace

Catalogue::Catalogue(fs::path installed, const std::vector<fs::path>& folders, const std::vector<fs::path>& files) {
  folders_.push_back(std::move(installed));
  folders_.insert(folders_.end(), folders.begin(), folders.end());
  for (const fs::path& folder : folders_) {
    std::error_code ignored;
    std::vector<fs::path> found;
    for (const auto& item : fs::directory_iterator(folder, ignored))
      if (item.path().extension() == ".so") found.push_back(item.path());
    std::sort(found.begin(), found.end());
    for (const fs::path& file : found) read_library(file, false);
  }
  for (const fs::path& file : files) read_library(file, true);
}

Catalogue Catalogue::standard(const std::vector<fs::path>& files) {
  std::vector<fs::path> folders;
  if (const char* path = std::getenv("RICOCHET_PLUGIN_PATH")) {
    std::istringstream parts{std::string(path)};
    for (std::string part; std::getline(parts, part, ':');)
      if (!part.empty()) folders.emplace_back(part);
  }
  return Catalogue(installed_plugins(), folders, files);
}

void Catalogue::read_library(const fs::path& file, bool insist) {
  Methods methods;
  const auto refuse = [&](const std::string& reason) {
    if (insist) throw PluginError(file.string() + ": " + reason);
    unusable_.push_back({file, reason, methods.empty() ? meant_by_name(file) : methods});
  };
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return refuse("no such file");
  std::vector<ExportedSymbol> symbols;
  try {
    symbols = exported_symbols(file, "ricochet_");
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
  std::string strange;
  Layout layout;
  for (const auto& [name, size] : symbols) {
    if (name == own_symbol && file.parent_path() == folders_.front()) own_.insert(file);
    if (name.starts_with(layout_prefix)) layout[name.substr(layout_prefix.size())] = size;
    if (!name.starts_with(provides_prefix)) continue;
    if (const auto method = parse_provides(name))
      methods.push_back(*method);
    else
      strange = name;
  }
  const auto tag =
      std::find_if(symbols.begin(), symbols.end(), [](const auto& s) { return s.name.starts_with(abi_prefix); });
  if (tag == symbols.end())
    return refuse(
        "a shared library, but no Ricochet plugin (it carries no ABI tag; does it end with RICOCHET_PLUGIN?)");
  for (const auto& wrong : {abi_mismatch(tag->name), layout_mismatch(layout)})
    if (wrong) return refuse("built for another ABI: " + *wrong + "; rebuild it against this version of Ricochet");
  if (!strange.empty()) return refuse("provides a role that this version does not know: " + strange);
  if (methods.empty()) return refuse("names no method that it provides; does it end with RICOCHET_PLUGIN?");
  for (const auto& [role, name] : methods) provided_.push_back({role, name, file});
}

std::vector<std::string> Catalogue::names(Role role) const {
  std::vector<std::string> result;
  for (const Provided& method : provided_)
    if (method.role == role && std::find(result.begin(), result.end(), method.name) == result.end())
      result.push_back(method.name);
  std::sort(result.begin(), result.end());
  return result;
}

const Unusable* Catalogue::unusable_provider(Role role, const std::string& name) const {
  for (const Unusable& file : unusable_)
    if (std::find(file.meant.begin(), file.meant.end(), std::pair(role, name)) != file.meant.end()) return &file;
  return nullptr;
}

const Provided* Catalogue::first_provider(Role role, const std::string& name) const {
  const auto found = std::find_if(provided_.begin(), provided_.end(),
                                  [&](const Provided& method) { return method.role == role && method.name == name; });
  return found == provided_.end() ? nullptr : &*found;
}

const fs::path* Catalogue::provider(Role role, const std::string& name) const {
  const Provided* first = first_provider(role, name);
  return first ? &first->file : nullptr;
}

std::vector<fs::path> Catalogue::shadowed(Role role, const std::string& name) const {
  std::vector<fs::path> files;
  const fs::path* const first = provider(role, name);
  for (const Provided& method : provided_)
    if (method.role == role && method.name == name && method.file != *first) files.push_back(method.file);
  return files;
}

bool Catalogue::foreign(const fs::path& file) const {
  return !file.empty() && own_.count(file) == 0 && read_.count(file) == 0;
}

std::vector<fs::path> Catalogue::missing_folders() const {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (const fs::path& folder : folders_)
    if (!fs::is_directory(folder, ignored)) missing.push_back(folder);
  return missing;
}

bool Catalogue::require(Role role, const std::string& name, Registry& registry) {
  if (registry.manual(role, name)) return true;
  const Provided* method = first_provider(role, name);
  if (!method) return false;
  if (const auto read = read_.find(method->file); read != read_.end()) {
    if (std::find(opened_.begin(), opened_.end(), method->file) == opened_.end()) opened_.push_back(method->file);
    adopt(method->file, read->second, registry);
    return true;
  }
  const PluginIdentity loaded{role_name(role), name, method->file.string()};
  const PluginCallScope scope(loaded, "load");
  open(method->file, registry);
  return true;
}

void Catalogue::open_all(Registry& registry) {
  for (const Provided& method : provided_) {
    const auto known = [&](const Unusable& unusable) { return unusable.file == method.file; };
    if (std::any_of(unusable_.begin(), unusable_.end(), known)) continue;
    try {
      require(method.role, method.name, registry);
    } catch (const PluginError& error) {
      const std::string prefix = method.file.string() + ": ";
      std::string reason = error.what();
      if (reason.starts_with(prefix)) reason.erase(0, prefix.size());
      Methods methods;
      for (const Provided& other : provided_)
        if (other.file == method.file) methods.emplace_back(other.role, other.name);
      unusable_.push_back({method.file, reason, methods});
    }
  }
}

void Catalogue::provide(const fs::path& file, Registry methods, bool first) {
  std::vector<Provided> provided;
  for (const Role role : all_roles)
    for (const std::string& name : methods.names(role)) provided.push_back({role, name, file});
  provided_.insert(first ? provided_.begin() : provided_.end(), provided.begin(), provided.end());
  read_.insert_or_assign(file, std::move(methods));
}

void Catalogue::open(const fs::path& file, Registry& registry) {
  if (std::find(opened_.begin(), opened_.end(), file) == opened_.end()) opened_.push_back(file);
  if (foreign(file) && !ForeignCode::may_run()) return adopt(file, describe_library(file, remark_), registry);
  Registry found;
  found.set_current_file(file.string());
  load_library(file, found);
  adopt(file, found, registry);
}

void Catalogue::adopt(const fs::path& file, const Registry& from, Registry& registry) const {
  std::string missing, more;
  Methods mine;
  for (const Provided& method : provided_) {
    if (method.file != file) continue;
    if (!from.manual(method.role, method.name))
      missing += (missing.empty() ? "" : ", ") + text(method.role, method.name);
    mine.emplace_back(method.role, method.name);
  }
  for (const Role role : all_roles)
    for (const std::string& name : from.names(role))
      if (std::find(mine.begin(), mine.end(), std::pair(role, name)) == mine.end())
        more += (more.empty() ? "" : ", ") + text(role, name);
  if (!missing.empty())
    throw PluginError(file.string() + ": says that it provides " + missing + " but does not register it" +
                      (more.empty() ? "" : "; it registers " + more));
  if (!more.empty())
    throw PluginError(file.string() + ": registers " + more + " without saying so; add RICOCHET_PROVIDES(role, name)");
  // Whichever file is opened first, a method comes from its first provider.
  for (const auto& [role, name] : mine)
    if (!registry.manual(role, name) && first_provider(role, name)->file == file) registry.adopt(role, name, from);
}

}  // namespace ricochet
