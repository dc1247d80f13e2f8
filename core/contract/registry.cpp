#include <algorithm>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/registry.hpp>

namespace ricochet {
namespace {

template <class Map>
auto* find(Map& map, const std::string& name) {
  const auto found = map.find(name);
  return found == map.end() ? nullptr : &found->second;
}

}  // namespace

const char* role_name(Role role) {
  switch (role) {
    case Role::mass:
      return "mass";
    case Role::contact:
      return "contact";
    case Role::time:
      return "time";
    case Role::reference:
      break;
  }
  return "reference";
}

void Registry::check(Role role, const PluginManual& manual) const {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
  if (manual.name.empty() || !std::all_of(manual.name.begin(), manual.name.end(), allowed))
    throw PluginError("a " + std::string(role_name(role)) + " plugin registers the name '" + manual.name +
                      "'; names are made of a-z, 0-9 and '-'");
  if (this->manual(role, manual.name))
    throw PluginError("the " + std::string(role_name(role)) + " plugin '" + manual.name + "' is registered twice");
  for (const ParameterSpec& spec : manual.parameters)
    if (spec.fallback)
      if (const auto wrong = check_parameter(spec, *spec.fallback))
        throw PluginError("the default of parameter '" + spec.key + "' of '" + manual.name +
                          "' does not fit: " + *wrong);
}

void Registry::add_mass(PluginManual manual, std::function<std::unique_ptr<MassStrategy>(const Parameters&)> make) {
  check(Role::mass, manual);
  const std::string name = manual.name;
  mass_.emplace(name, Entry<MassStrategy>{std::move(manual), std::move(make), current_file_});
}
void Registry::add_contact(PluginManual manual, std::function<std::unique_ptr<ContactLaw>(const Parameters&)> make) {
  check(Role::contact, manual);
  const std::string name = manual.name;
  contact_.emplace(name, Entry<ContactLaw>{std::move(manual), std::move(make), current_file_});
}
void Registry::add_time(PluginManual manual, std::function<std::unique_ptr<TimeScheme>(const Parameters&)> make) {
  check(Role::time, manual);
  const std::string name = manual.name;
  time_.emplace(name, Entry<TimeScheme>{std::move(manual), std::move(make), current_file_});
}
void Registry::add_reference(PluginManual manual,
                             std::function<std::unique_ptr<ReferenceSolver>(const Parameters&)> make) {
  check(Role::reference, manual);
  const std::string name = manual.name;
  reference_.emplace(name, Entry<ReferenceSolver>{std::move(manual), std::move(make), current_file_});
}

const Entry<MassStrategy>* Registry::mass(const std::string& name) const {
  return find(mass_, name);
}
const Entry<ContactLaw>* Registry::contact(const std::string& name) const {
  return find(contact_, name);
}
const Entry<TimeScheme>* Registry::time(const std::string& name) const {
  return find(time_, name);
}
const Entry<ReferenceSolver>* Registry::reference(const std::string& name) const {
  return find(reference_, name);
}

const PluginManual* Registry::manual(Role role, const std::string& name) const {
  switch (role) {
    case Role::mass:
      if (const auto* entry = mass(name)) return &entry->manual;
      break;
    case Role::contact:
      if (const auto* entry = contact(name)) return &entry->manual;
      break;
    case Role::time:
      if (const auto* entry = time(name)) return &entry->manual;
      break;
    case Role::reference:
      if (const auto* entry = reference(name)) return &entry->manual;
      break;
  }
  return nullptr;
}

std::string Registry::file(Role role, const std::string& name) const {
  const auto of = [](const auto* entry) { return entry ? entry->file : std::string(); };
  switch (role) {
    case Role::mass:
      return of(mass(name));
    case Role::contact:
      return of(contact(name));
    case Role::time:
      return of(time(name));
    case Role::reference:
      break;
  }
  return of(reference(name));
}

std::vector<std::string> Registry::names(Role role) const {
  std::vector<std::string> result;
  const auto collect = [&](const auto& map) {
    for (const auto& [name, entry] : map) result.push_back(name);
  };
  switch (role) {
    case Role::mass:
      collect(mass_);
      break;
    case Role::contact:
      collect(contact_);
      break;
    case Role::time:
      collect(time_);
      break;
    case Role::reference:
      collect(reference_);
      break;
  }
  return result;
}

}  // namespace ricochet
