#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <ricochet/contract/registry.hpp>

namespace ricochet {

/// A method that a library on disk says it provides (read from its symbol table, without running its code).
struct Provided {
  Role role;
  std::string name;
  std::filesystem::path file;
};

/// A file in a plugin folder that cannot serve, and why (not a library, no Ricochet plugin, wrong ABI tag).
struct Unusable {
  std::filesystem::path file;
  std::string reason;
};

/// The plugin libraries found, and the act of opening one. Search order: the install folder, then RICOCHET_PLUGIN_PATH
/// (colon-separated folders), then single files. The first provider of a (role, name) wins; later ones are listed as shadowed.
class Catalogue {
 public:
  /// `installed`: the folder of our own plugins; `files`: from --plugin.
  /// A file from `files` that cannot serve is a PluginError at once; in folders it is kept in unusable().
  Catalogue(std::filesystem::path installed, const std::vector<std::filesystem::path>& folders,
            const std::vector<std::filesystem::path>& files);
  /// The standard one: folder next to the running program, RICOCHET_PLUGIN_PATH, and `files`.
  static Catalogue standard(const std::vector<std::filesystem::path>& files = {});

  const std::vector<Provided>& provided() const { return provided_; }
  const std::vector<Unusable>& unusable() const { return unusable_; }
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  std::vector<std::string> names(Role role) const;

  /// Opens the library that provides the method and lets it register, unless it is there already. Returns false when no
  /// file provides it. Throws PluginError (naming the file) when it does not load, throws while it registers, or does not
  /// register what it said.
  bool require(Role role, const std::string& name, Registry& registry);
  /// Opens everything (for `describe` without a name and for `schema`); failures go to unusable().
  void open_all(Registry& registry);
  /// Libraries opened so far.
  const std::vector<std::filesystem::path>& opened() const { return opened_; }

 private:
  void look_at(const std::filesystem::path& file, bool insist);
  void open(const std::filesystem::path& file, Registry& registry);
  std::vector<std::filesystem::path> folders_;
  std::vector<Provided> provided_;
  std::vector<Unusable> unusable_;
  std::vector<std::filesystem::path> opened_;
};

}  // namespace ricochet
