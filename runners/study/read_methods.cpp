#include "runners/study/read_methods.hpp"

#include <algorithm>

#include "runners/json/json_text.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/product.hpp"

namespace ricochet {
namespace {

const char* role_phrase(Role role) {
  switch (role) {
    case Role::mass:
      return "mass strategy";
    case Role::contact:
      return "contact law";
    case Role::time:
      return "time scheme";
    case Role::reference:
      break;
  }
  return "reference";
}

const PluginManual& require_method(Role role, const std::string& name, const std::string& pointer, Catalogue& catalogue,
                                   Registry& registry) {
  if (catalogue.require(role, name, registry)) return *registry.manual(role, name);
  std::vector<std::string> names = catalogue.names(role);
  for (const std::string& known : registry.names(role))
    if (std::find(names.begin(), names.end(), known) == names.end()) names.push_back(known);
  std::string message = std::string("no plugin provides the ") + role_phrase(role) + " \"" + shortened(name) + "\"" +
                        did_you_mean(name, names);
  message += names.empty() ? " (no " + std::string(role_phrase(role)) +
                                 " was found at all; `ricochet doctor` shows the plugin folders)"
                           : " (found: " + quoted_list(names) + ")";
  // Where a file that cannot serve is meant for this method, or tells nothing of itself and no name is near, the file
  // is the fault, not the study.
  const Unusable* meant = catalogue.unusable_provider(role, name);
  std::vector<const Unusable*> suspects;
  for (const Unusable& file : catalogue.unusable())
    if (meant ? &file == meant : file.meant.empty()) suspects.push_back(&file);
  if (suspects.empty()) throw InputError(pointer, message);
  if (!meant && !nearest_name(name, names).empty())
    throw InputError(pointer, message + "; `ricochet doctor` tells of plugin files that cannot serve");
  message =
      "at " + pointer + ": " + message +
      (suspects.size() == 1 ? "; this file was found and cannot serve:" : "; these files were found and cannot serve:");
  for (const Unusable* file : suspects) message += "\n  " + file->file.string() + ": " + file->reason;
  throw PluginError(message);
}

Json as_object(const Json& entry, const std::string& pointer) {
  if (entry.is_string()) return Json{{"name", entry}};
  if (!entry.is_object())
    throw InputError(pointer,
                     "expected the name of a method or an object {\"name\": …, parameters}, found " + quote(entry));
  return entry;
}

std::string name_of(const Json& entry, const std::string& pointer) {
  const auto name = entry.find("name");
  if (name == entry.end()) {
    for (const auto& [key, ignored] : entry.items())
      if (nearest_name(key, {"name"}) == "name")
        throw InputError(pointer_to(pointer, key), "unknown key \"" + shortened(key) + "\"; did you mean \"name\"?");
    throw InputError(pointer_to(pointer, "name"), "missing; a method needs the name of its plugin");
  }
  if (!name->is_string())
    throw InputError(pointer_to(pointer, "name"), "expected the name of one method, found " + quote(*name));
  return name->get<std::string>();
}

ParameterValue to_value(const ParameterSpec& spec, const Json& value) {
  switch (spec.type) {
    case ParameterSpec::Type::real:
      return value.get<double>();
    case ParameterSpec::Type::integer:
      return value.get<long long>();
    case ParameterSpec::Type::boolean:
      return value.get<bool>();
    case ParameterSpec::Type::word:
      break;
  }
  return value.get<std::string>();
}

}  // namespace

MethodOptions read_methods(Role role, const Json& value, const std::string& pointer, Catalogue& catalogue,
                           Registry& registry, const std::filesystem::path& folder) {
  MethodOptions result;
  result.resolved = Json::array();
  const bool list = value.is_array();
  if (list && value.empty())
    throw InputError(pointer, "an empty list makes no cases; name at least one " + std::string(role_phrase(role)));
  const std::size_t count = list ? value.size() : 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string here = list ? pointer_to(pointer, i) : pointer;
    const Json& given = list ? value[i] : value;
    Json entry = as_object(given, here);
    std::optional<PlanSource> plan;
    if (role == Role::time) plan = take_stated_plan(entry, here, folder, result.resolved, catalogue, registry);
    const std::string name = name_of(entry, here);
    const PluginManual& manual =
        require_method(role, name, given.is_object() ? pointer_to(here, "name") : here, catalogue, registry);
    std::vector<Axis> axes;
    Json complete = check_object(method_form(manual), entry, here, axes);
    std::shared_ptr<const std::string> content;
    if (plan) {
      content = std::make_shared<const std::string>(plan->plan.dump());
      complete["plan"] = std::move(plan->plan);
    }
    result.resolved.push_back(complete);

    Product product;
    for (const Axis& axis : axes) product.add(axis.values.size());
    product.refuse_above(largest_study, here);
    for (; !product.ended(); product.next()) {
      MethodOption option;
      option.choice.name = name;
      option.choice.plan = content;
      option.places.push_back(here);
      option.axes.emplace_back(role_name(role), name);
      Json scalars = complete;
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const std::string key = axes[a].pointer.substr(here.size() + 1);
        scalars[key] = axes[a].values[product[a]];
        option.places.push_back(pointer_to(axes[a].pointer, product[a]));
      }
      for (const ParameterSpec& spec : manual.parameters) {
        option.axes.emplace_back(std::string(role_name(role)) + "." + spec.key, scalars[spec.key]);
        option.choice.parameters.set(spec.key, to_value(spec, scalars[spec.key]));
      }
      result.options.push_back(std::move(option));
    }
  }
  return result;
}

}  // namespace ricochet
