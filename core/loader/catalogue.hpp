#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <ricochet/contract/registry.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  /// What it would provide if it could serve: by its symbols, or, where they tell nothing, by a file name ROLE-NAME.so.
  std::vector<std::pair<Role, std::string>> meant = {};
};

/// The plugin libraries found, and the act of opening one. Search order: the install folder, then RICOCHET_PLUGIN_PATH
/// (colon-separated folders), then single files. The first provider of a (role, name) wins; later ones are listed as
/// shadowed.
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
  /// The libraries that provide the method too, after the one that is used: it stands in their place.
  std::vector<std::filesystem::path> shadowed(Role role, const std::string& name) const;
  /// The file that provides the method, or null.
  const std::filesystem::path* provider(Role role, const std::string& name) const;
  /// Whether a file is a library and none of the program's own in the install folder. Where code of such files may not
  /// run (ForeignCode), a child process says what it registers, and its code is loaded by who asks for an object.
  bool foreign(const std::filesystem::path& file) const;
  /// Folders to search that are none (a misspelt entry of RICOCHET_PLUGIN_PATH).
  std::vector<std::filesystem::path> missing_folders() const;
  /// The unusable file that is meant to provide the method, or null.
  const Unusable* unusable_provider(Role role, const std::string& name) const;

  /// Adds a file that is no library, with what its reader found in it. It comes after the files known so far, or before
  /// them all where `first`. require() takes its methods from there.
  void provide(const std::filesystem::path& file, Registry methods, bool first = false);
  /// Adds a file that its reader could not make anything of.
  void cannot_serve(Unusable file) { unusable_.push_back(std::move(file)); }

  /// Opens the library that provides the method and lets it register what it provides first, unless the method is there
  /// already. Returns false when no file provides it. Throws PluginError (naming the file) when the library does not
  /// load, throws while it registers, or does not register exactly what it says. The registry is then as it was before.
  /// It is a PluginError too where a foreign library ends the child process that opens it, or takes longer than 10 s.
  bool require(Role role, const std::string& name, Registry& registry);
  /// Opens everything (for `describe` without a name and for `schema`); failures go to unusable().
  void open_all(Registry& registry);
  /// Is told what a person should know of a library that serves all the same.
  void on_remark(std::function<void(const std::string&)> remark) { remark_ = std::move(remark); }
  /// Libraries opened so far.
  const std::vector<std::filesystem::path>& opened() const { return opened_; }

 private:
  void read_library(const std::filesystem::path& file, bool insist);
  void open(const std::filesystem::path& file, Registry& registry);
  void adopt(const std::filesystem::path& file, const Registry& from, Registry& registry) const;
  const Provided* first_provider(Role role, const std::string& name) const;
  std::vector<std::filesystem::path> folders_;
  std::vector<Provided> provided_;
  std::vector<Unusable> unusable_;
  std::vector<std::filesystem::path> opened_;
  std::set<std::filesystem::path> own_;
  std::function<void(const std::string&)> remark_;
  std::map<std::filesystem::path, Registry> read_;  // of files that are no libraries
};

/// A symbol that a library defines, with the size of its object in bytes (of a function: of its code).
struct ExportedSymbol {
  std::string name;
  std::uint64_t size = 0;
};

/// The symbols with names that begin with `prefix` that a shared library defines for others, in the order of their
/// names. They are read from the dynamic symbol table of the file. None of its code runs, and a stripped library still
/// tells them. Throws std::runtime_error with a reason: "not a shared library", "damaged: …", "built for another
/// processor". Nothing outside of the file is read, whatever bytes it holds. Source: System V ABI, chapters 4 and 5.
std::vector<ExportedSymbol> exported_symbols(const std::filesystem::path& file, std::string_view prefix);

/// The bytes by which the linker names what it made of a program or library: two files with one id run the same code.
/// "" where it gave none. Throws std::runtime_error as exported_symbols() does.
std::string build_id(const std::filesystem::path& file);

}  // namespace ricochet
