#include <algorithm>
#include <cmath>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/registry.hpp>
#include <sstream>

namespace ricochet {
namespace {

template <class Map>
auto* find(Map& map, const std::string& name) {
  const auto found = map.find(name);
  return found == map.end() ? nullptr : &found->second;
}

bool is_key(const std::string& key) {
  const auto lower = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto inside = [&](char c) { return lower(c) || (c >= '0' && c <= '9') || c == '_'; };
  return !key.empty() && lower(key.front()) && std::all_of(key.begin(), key.end(), inside);
}

// What is wrong with one parameter, beside those before it.
std::optional<std::string> check_declaration(const PluginManual& manual, std::size_t index) {
  const ParameterSpec& spec = manual.parameters[index];
  const std::string name = "the parameter '" + spec.key + "'";
  if (!is_key(spec.key))
    return name + "; keys begin with a letter and are made of a-z, 0-9 and '_', as a study writes them";
  // What the object of a method holds beside its parameters.
  for (const char* reserved : {"name", "file", "plan"})
    if (spec.key == reserved) return name + ", a key that every method has already; choose another";
  for (std::size_t i = 0; i < index; ++i) {
    const ParameterSpec& other = manual.parameters[i];
    if (other.key == spec.key) return name + " twice";
    if (spec.role != ParameterRole::none && other.role == spec.role)
      return name + " in the role of '" + other.key + "'; one parameter has each role";
  }
  if (spec.role != ParameterRole::none && spec.type != ParameterSpec::Type::real)
    return name + " in a role that only a number can have";
  if (spec.type == ParameterSpec::Type::word && spec.words.empty()) return name + " without any word to choose from";
  for (auto word = spec.words.begin(); word != spec.words.end(); ++word)
    if (word->empty() || std::find(spec.words.begin(), word, *word) != word)
      return name + (word->empty() ? " with an empty word" : " with the word '" + *word + "' twice");
  const Range& range = spec.range;
  const bool number = spec.type == ParameterSpec::Type::real || spec.type == ParameterSpec::Type::integer;
  const bool one_value = range.low == range.high && !range.low_open && !range.high_open;
  if (number && !(range.low < range.high) && !one_value) return name + " whose range " + range.text() + " is empty";
  const auto* real = spec.fallback ? std::get_if<double>(&*spec.fallback) : nullptr;
  if (real && !std::isfinite(*real)) return name + " with a default that is not finite: no study can write it";
  if (spec.fallback)
    if (const auto wrong = check_parameter(spec, *spec.fallback))
      return name + " with a default that does not fit: " + *wrong;
  return std::nullopt;
}

// A text may be written over several lines of a source: each run of white space is one blank.
std::string flowed(const std::string& text) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

class PlannedScheme final : public TimeScheme {
 public:
  PlannedScheme(PlanFunction plan, Parameters parameters)
      : plan_(std::move(plan)), parameters_(std::move(parameters)) {}
  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override { return plan_(parameters_, h, facts); }

 private:
  PlanFunction plan_;
  Parameters parameters_;
};

}  // namespace

const char* role_name(Role role) {
  switch (role) {
    case Role::mass:
      return "mass";
    case Role::contact:
      return "contact";
    case Role::friction:
      return "friction";
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
  for (std::size_t i = 0; i < manual.parameters.size(); ++i)
    if (const auto wrong = check_declaration(manual, i))
      throw PluginError("the " + std::string(role_name(role)) + " plugin '" + manual.name + "' declares " + *wrong);
}

template <class Interface>
void Registry::add(std::map<std::string, Entry<Interface>>& entries, Role role, PluginManual manual,
                   Maker<Interface> make) {
  check(role, manual);
  for (std::string* text : {&manual.summary, &manual.text, &manual.source}) *text = flowed(*text);
  for (ParameterSpec& spec : manual.parameters) spec.text = flowed(spec.text);
  const std::string name = manual.name;
  if (!make) throw PluginError("the " + std::string(role_name(role)) + " plugin '" + name + "' registers no factory");
  PluginIdentity identity{role_name(role), name, current_file_};
  if constexpr (std::is_same_v<Interface, ContactLaw>)
    make = guarded(std::move(identity), std::move(make), manual.parameters);
  else
    make = guarded(std::move(identity), std::move(make));
  entries.emplace(name, Entry<Interface>{std::move(manual), std::move(make), current_file_});
}

void Registry::add_mass(PluginManual manual, Maker<MassStrategy> make) {
  add(mass_, Role::mass, std::move(manual), std::move(make));
}
void Registry::add_contact(PluginManual manual, Maker<ContactLaw> make) {
  add(contact_, Role::contact, std::move(manual), std::move(make));
}
void Registry::add_friction(PluginManual manual, Maker<FrictionLaw> make) {
  add(friction_, Role::friction, std::move(manual), std::move(make));
}
void Registry::add_time(PluginManual manual, Maker<TimeScheme> make) {
  add(time_, Role::time, std::move(manual), std::move(make));
}
void Registry::add_time(PluginManual manual, PlanFunction plan) {
  add_time(std::move(manual), [plan = std::move(plan)](const Parameters& p) -> std::unique_ptr<TimeScheme> {
    return std::make_unique<PlannedScheme>(plan, p);
  });
}
void Registry::add_reference(PluginManual manual, Maker<ReferenceSolver> make) {
  add(reference_, Role::reference, std::move(manual), std::move(make));
}

void Registry::adopt(Role role, const std::string& name, const Registry& from) {
  switch (role) {
    case Role::mass:
      mass_.emplace(name, from.mass_.at(name));
      break;
    case Role::contact:
      contact_.emplace(name, from.contact_.at(name));
      break;
    case Role::friction:
      friction_.emplace(name, from.friction_.at(name));
      break;
    case Role::time:
      time_.emplace(name, from.time_.at(name));
      break;
    case Role::reference:
      reference_.emplace(name, from.reference_.at(name));
      break;
  }
}

const Entry<MassStrategy>* Registry::mass(const std::string& name) const {
  return find(mass_, name);
}
const Entry<ContactLaw>* Registry::contact(const std::string& name) const {
  return find(contact_, name);
}
const Entry<FrictionLaw>* Registry::friction(const std::string& name) const {
  return find(friction_, name);
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
    case Role::friction:
      if (const auto* entry = friction(name)) return &entry->manual;
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
    case Role::friction:
      return of(friction(name));
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
    case Role::friction:
      collect(friction_);
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
