#include <ricochet/contract/catalogue.hpp>

#include <ricochet/contract/abi.hpp>

#include <boost/dll/library_info.hpp>
#include <boost/dll/runtime_symbol_info.hpp>
#include <boost/dll/shared_library.hpp>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace ricochet {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view provides_prefix = "ricochet_provides__";
constexpr std::string_view abi_prefix = "ricochet_abi__";

std::vector<std::string> marked_symbols(const fs::path& file) {
  boost::dll::library_info info(file.string());
  return info.symbols("ricochet");
}

std::optional<std::pair<Role, std::string>> parse_provides(std::string_view symbol) {
  symbol.remove_prefix(provides_prefix.size());
  for (const Role role : {Role::mass, Role::contact, Role::time}) {
    const std::string prefix = std::string(role_name(role)) + "__";
    if (!symbol.starts_with(prefix)) continue;
    std::string name(symbol.substr(prefix.size()));
    std::replace(name.begin(), name.end(), '_', '-');
    return std::pair(role, name);
  }
  return std::nullopt;
}

// Libraries stay open for the life of the process: methods made from them may outlive any catalogue.
std::vector<boost::dll::shared_library>& open_libraries() {
  static auto* libraries = new std::vector<boost::dll::shared_library>;
  return *libraries;
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
    for (const fs::path& file : found) look_at(file, false);
  }
  for (const fs::path& file : files) look_at(file, true);
}

Catalogue Catalogue::standard(const std::vector<fs::path>& files) {
  const fs::path program = boost::dll::program_location().string();
  fs::path installed = program.parent_path().parent_path() / "lib" / "ricochet";
  std::error_code ignored;
  // A distribution may install libraries under lib/<triplet>.
  if (!fs::is_directory(installed, ignored))
    for (const auto& item : fs::directory_iterator(installed.parent_path(), ignored))
      if (fs::is_directory(item.path() / "ricochet", ignored)) installed = item.path() / "ricochet";
  std::vector<fs::path> folders;
  if (const char* path = std::getenv("RICOCHET_PLUGIN_PATH")) {
    std::istringstream parts{std::string(path)};
    for (std::string part; std::getline(parts, part, ':');)
      if (!part.empty()) folders.emplace_back(part);
  }
  return Catalogue(installed, folders, files);
}

void Catalogue::look_at(const fs::path& file, bool insist) {
  const auto refuse = [&](const std::string& reason) {
    if (insist) throw PluginError(file.string() + ": " + reason);
    unusable_.push_back({file, reason});
  };
  std::vector<std::string> symbols;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return refuse("no such file");
  try {
    symbols = marked_symbols(file);
  } catch (const std::exception&) {
    return refuse("not a shared library of this system, or damaged");
  }
  const auto tag = std::find_if(symbols.begin(), symbols.end(), [](const auto& s) { return s.starts_with(abi_prefix); });
  if (tag == symbols.end())
    return refuse("a shared library, but no Ricochet plugin (it carries no ABI tag; does it end with RICOCHET_PLUGIN?)");
  if (const auto wrong = abi_mismatch(*tag))
    return refuse("built for another ABI: " + *wrong + "; rebuild it against this version of Ricochet");
  for (const std::string& symbol : symbols) {
    if (!symbol.starts_with(provides_prefix)) continue;
    if (const auto method = parse_provides(symbol))
      provided_.push_back({method->first, method->second, file});
    else
      return refuse("provides a role that this version does not know: " + symbol);
  }
}

std::vector<std::string> Catalogue::names(Role role) const {
  std::vector<std::string> result;
  for (const Provided& method : provided_)
    if (method.role == role && std::find(result.begin(), result.end(), method.name) == result.end())
      result.push_back(method.name);
  std::sort(result.begin(), result.end());
  return result;
}

bool Catalogue::require(Role role, const std::string& name, Registry& registry) {
  if (registry.manual(role, name)) return true;
  const auto found = std::find_if(provided_.begin(), provided_.end(),
                                  [&](const Provided& method) { return method.role == role && method.name == name; });
  if (found == provided_.end()) return false;
  const fs::path file = found->file;
  open(file, registry);
  if (!registry.manual(role, name))
    throw PluginError(file.string() + ": says that it provides " + role_name(role) + " '" + name +
                      "' but does not register it");
  return true;
}

void Catalogue::open_all(Registry& registry) {
  for (const Provided& method : std::vector<Provided>(provided_)) {
    try {
      require(method.role, method.name, registry);
    } catch (const PluginError& error) {
      const std::string prefix = method.file.string() + ": ";
      std::string reason = error.what();
      if (reason.starts_with(prefix)) reason.erase(0, prefix.size());
      unusable_.push_back({method.file, reason});
    }
  }
}

void Catalogue::open(const fs::path& file, Registry& registry) {
  boost::dll::shared_library library;
  try {
    library.load(fs::absolute(file).string(), boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  } catch (const std::exception& error) {
    throw PluginError(file.string() + ": cannot be loaded: " + error.what());
  }
  // Kept open even when registering fails: what was registered before may hold its code.
  open_libraries().push_back(library);
  registry.set_current_file(file.string());
  try {
    library.get<void(Registry&)>("ricochet_register")(registry);
  } catch (const PluginError& error) {
    throw PluginError(file.string() + ": " + error.what());
  } catch (const std::exception& error) {
    throw PluginError(file.string() + ": failed while registering: " + error.what());
  } catch (...) {
    throw PluginError(file.string() + ": failed while registering, with an exception that says nothing");
  }
  registry.set_current_file("");
  opened_.push_back(file);
}

}  // namespace ricochet
