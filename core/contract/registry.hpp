#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/guarded.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/parameters.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/time_scheme.hpp>
#include <string>
#include <vector>

namespace ricochet {

enum class Role { mass, contact, time, reference };
inline constexpr std::array all_roles = {Role::mass, Role::contact, Role::time, Role::reference};
const char* role_name(Role role);

/// The manual of a plugin, registered together with its factory so that it cannot drift.
struct PluginManual {
  std::string name;     ///< [a-z0-9-]+
  std::string summary;  ///< one line
  std::string text;     ///< one paragraph; each run of white space counts as one blank
  std::string source;   ///< author, year, equation
  std::vector<ParameterSpec> parameters;
};

/// One registered method.
template <class Interface>
struct Entry {
  PluginManual manual;
  Maker<Interface> make;  ///< guarded (see guarded.hpp)
  std::string file;       ///< library it came from
};

/// All methods known to this process, by role and name. Core registers none itself. Adding one throws a PluginError
/// when its name is no name or is taken, or when its parameters cannot be what a study writes.
class Registry {
 public:
  void add_mass(PluginManual manual, Maker<MassStrategy> make);
  void add_contact(PluginManual manual, Maker<ContactLaw> make);
  void add_time(PluginManual manual, Maker<TimeScheme> make);
  void add_reference(PluginManual manual, Maker<ReferenceSolver> make);

  /// Takes over a method of another registry, with its file; it must be there, and not here.
  void adopt(Role role, const std::string& name, const Registry& from);

  const Entry<MassStrategy>* mass(const std::string& name) const;
  const Entry<ContactLaw>* contact(const std::string& name) const;
  const Entry<TimeScheme>* time(const std::string& name) const;
  const Entry<ReferenceSolver>* reference(const std::string& name) const;
  const PluginManual* manual(Role role, const std::string& name) const;
  /// File of a method's library, "" when registered in-process.
  std::string file(Role role, const std::string& name) const;
  std::vector<std::string> names(Role role) const;
  /// The library that registers from now on, recorded with each entry.
  void set_current_file(std::string file) { current_file_ = std::move(file); }

 private:
  void check(Role role, const PluginManual& manual) const;
  template <class Interface>
  void add(std::map<std::string, Entry<Interface>>& entries, Role role, PluginManual manual, Maker<Interface> make);
  std::map<std::string, Entry<MassStrategy>> mass_;
  std::map<std::string, Entry<ContactLaw>> contact_;
  std::map<std::string, Entry<TimeScheme>> time_;
  std::map<std::string, Entry<ReferenceSolver>> reference_;
  std::string current_file_;
};

}  // namespace ricochet
