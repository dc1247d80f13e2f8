#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/contract/friction_law.hpp>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/contract/parameters.hpp>
#include <ricochet/contract/plugin_call.hpp>
#include <ricochet/contract/reference.hpp>
#include <ricochet/contract/step_plan.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// The factory of one method, as a plugin registers it.
template <class Interface>
using Maker = std::function<std::unique_ptr<Interface>(const Parameters&)>;

/// The same factory, whose objects answer for what they do. Every function runs inside a PluginCallScope. An InputError
/// or a PluginError passes: it says already what to do. Any other exception arrives as a PluginFault that names plugin,
/// file and function.
/// So does an answer that the contract forbids: no object, an ill-formed plan, a refusal without a sentence, numbers or
/// sizes that cannot be. Other such answers are a mass that check_inertia() finds wrong and a motion that does not fit
/// its grid. The registry puts every factory through this, so that nobody holds an unguarded object.
Maker<MassStrategy> guarded(PluginIdentity plugin, Maker<MassStrategy> make);
Maker<ContactLaw> guarded(PluginIdentity plugin, Maker<ContactLaw> make, std::vector<ParameterSpec> declared = {});
Maker<FrictionLaw> guarded(PluginIdentity plugin, Maker<FrictionLaw> make);
Maker<TimeScheme> guarded(PluginIdentity plugin, Maker<TimeScheme> make);
Maker<ReferenceSolver> guarded(PluginIdentity plugin, Maker<ReferenceSolver> make);

/// A time scheme as one function: its plan, or a refusal, for these parameters, the step h (s) and the problem.
using PlanFunction = std::function<PlanOrRefusal(const Parameters&, double h, const ProblemFacts&)>;

enum class Role { mass, contact, friction, time, reference };
inline constexpr std::array all_roles = {Role::mass, Role::contact, Role::friction, Role::time, Role::reference};
const char* role_name(Role role);

/// The manual of a plugin, registered together with its factory so that it cannot drift. In its texts and those of its
/// parameters each run of white space counts as one blank.
struct PluginManual {
  std::string name;     ///< [a-z0-9-]+
  std::string summary;  ///< one line
  std::string text;     ///< one paragraph
  std::string source;   ///< author, year, equation
  std::vector<ParameterSpec> parameters;
  std::string words = {};  ///< what sentences call it, "rigid stops"; "": its name
};

/// One registered method.
template <class Interface>
struct Entry {
  PluginManual manual;
  Maker<Interface> make;  ///< guarded()
  std::string file;       ///< library it came from
};

/// All methods known to this process, by role and name. Core registers none itself. Adding one throws a PluginError
/// when its name is no name or is taken, or when its parameters cannot be what a study writes.
class Registry {
 public:
  void add_mass(PluginManual manual, Maker<MassStrategy> make);
  void add_contact(PluginManual manual, Maker<ContactLaw> make);
  void add_friction(PluginManual manual, Maker<FrictionLaw> make);
  void add_time(PluginManual manual, Maker<TimeScheme> make);
  void add_time(PluginManual manual, PlanFunction plan);
  void add_reference(PluginManual manual, Maker<ReferenceSolver> make);

  /// Takes over a method of another registry, with its file; it must be there, and not here.
  void adopt(Role role, const std::string& name, const Registry& from);

  const Entry<MassStrategy>* mass(const std::string& name) const;
  const Entry<ContactLaw>* contact(const std::string& name) const;
  const Entry<FrictionLaw>* friction(const std::string& name) const;
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
  std::map<std::string, Entry<FrictionLaw>> friction_;
  std::map<std::string, Entry<TimeScheme>> time_;
  std::map<std::string, Entry<ReferenceSolver>> reference_;
  std::string current_file_;
};

}  // namespace ricochet
