#include "runners/plan_files/plan_file.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "runners/json/json_text.hpp"

namespace ricochet {
namespace fs = std::filesystem;
namespace {

constexpr const char* file_key = "file";
constexpr const char* plan_key = "plan";

bool states_plan(const Json& entry) {
  const auto name = entry.find("name");
  const auto plan = entry.find(plan_key);
  return (name != entry.end() && *name == stated_plan) || (plan != entry.end() && plan->is_object());
}

PlanSource source_of(const Json& entry, const std::string& pointer, const fs::path& folder) {
  const auto file = entry.find(file_key), plan = entry.find(plan_key);
  if (file != entry.end() && plan != entry.end())
    throw InputError(pointer_to(pointer, plan_key), "does not go together with \"file\"; expected one of them");
  if (plan != entry.end()) {
    PlanSource source;
    source.plan = *plan;
    source.pointer = pointer_to(pointer, plan_key);
    return source;
  }
  if (file == entry.end()) {
    for (const auto& [key, ignored] : entry.items())
      if (const std::string near = nearest_name(key, {file_key, plan_key}); !near.empty())
        throw InputError(pointer_to(pointer, key),
                         "unknown key \"" + shortened(key) + "\"; did you mean \"" + near + "\"?");
    throw InputError(pointer_to(pointer, file_key),
                     "missing; the time scheme \"plan\" has the path of a plan here, or the plan itself as \"plan\"");
  }
  const std::string here = pointer_to(pointer, file_key);
  if (!file->is_string() || file->get<std::string>().empty())
    throw InputError(here, "expected the path of a plan, a JSON file, found " + quote(*file));
  try {
    return read_plan_file((folder / file->get<std::string>()).lexically_normal());
  } catch (const InputError& error) {
    throw InputError(here, error.what());
  }
}

// Whether the name is free, or stands for this very plan already; throws where it stands for something else.
bool is_new(const PlanSource& source, const std::string& name, const std::string& where, const Json& before,
            const Catalogue& catalogue, const Registry& registry) {
  for (const Json& other : before) {
    if (other.at("name") != name || !other.contains(plan_key)) continue;
    if (other.at(plan_key) == source.plan) return false;
    throw InputError(where, "another plan of this study has the name \"" + shortened(name) +
                                "\" already: tables could not tell them apart; give it a name of its own");
  }
  const auto refuse = [&](const std::string& provider) {
    throw InputError(where, "the plan states the name \"" + shortened(name) + "\", which the time scheme of " +
                                provider + " has: tables could not tell them apart; give it a name of its own");
  };
  const auto& all = catalogue.provided();
  const auto provider = std::find_if(
      all.begin(), all.end(), [&](const Provided& method) { return method.role == Role::time && method.name == name; });
  const bool plan_file = provider != all.end() && provider->file.extension() == ".json";
  if (provider != all.end() && !plan_file) refuse(provider->file.string());
  if (!registry.manual(Role::time, name)) return true;
  // Named before in this study, from a plugin folder.
  if (plan_file && read_plan_file(provider->file).plan == source.plan) return false;
  refuse(plan_file ? provider->file.string() : "this program");
  return true;
}

void add_plan(const fs::path& file, Catalogue& catalogue, bool insist) {
  std::string name = file.stem().string();
  try {
    PlanSource source = read_plan_file(file);
    if (source.plan.is_object() && source.plan.contains("name") && source.plan["name"].is_string())
      name = source.plan["name"].get<std::string>();
    Registry methods;
    try {
      register_plan(source, methods);
    } catch (const InputError& error) {
      throw PluginError(source.explain(error));
    }
    catalogue.provide(file, std::move(methods));
  } catch (const std::runtime_error& error) {
    if (insist) throw PluginError(error.what());
    std::string reason = error.what();
    if (reason.starts_with(file.string() + ":")) reason.erase(0, file.string().size() + 1);
    if (reason.starts_with(" "))
      reason.erase(0, 1);
    else
      reason.insert(0, "line ");
    catalogue.cannot_serve({file, reason, {{Role::time, name}}});
  }
}

// A folder of plugins may hold studies and other JSON.
bool holds_plan(const fs::path& file) {
  try {
    const PlanSource source = read_plan_file(file);
    return source.plan.is_object() && (source.plan.contains("slots") || source.plan.contains("stages"));
  } catch (const InputError&) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return text.find("\"slots\"") != std::string::npos && text.find("\"methods\"") == std::string::npos;
  }
}

}  // namespace

std::optional<PlanSource> take_stated_plan(Json& entry, const std::string& pointer, const fs::path& folder,
                                           const Json& before, Catalogue& catalogue, Registry& registry) {
  if (!states_plan(entry)) return std::nullopt;
  PlanSource source = source_of(entry, pointer, folder);
  const std::string where = source.file.empty() ? source.pointer : pointer_to(pointer, file_key);
  std::string name;
  Registry methods;
  try {
    name = check_plan_source(source).name;
  } catch (const InputError& error) {
    if (source.file.empty()) throw;
    throw InputError(where, source.explain(error));
  }
  if (const auto given = entry.find("name"); given != entry.end() && *given != stated_plan && *given != name)
    throw InputError(pointer_to(pointer, "name"), "expected \"plan\" or \"" + shortened(name) +
                                                      "\", the name that the plan states, found " + quote(*given));
  if (is_new(source, name, where, before, catalogue, registry)) {
    register_plan(source, source.file.empty() ? registry : methods);
    if (!source.file.empty()) {
      catalogue.provide(source.file, std::move(methods), true);
      catalogue.require(Role::time, name, registry);
    }
  }
  entry.erase(file_key);
  entry.erase(plan_key);
  entry["name"] = name;
  return source;
}

void add_plans(const fs::path& folder, Catalogue& catalogue) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(folder, ignored))
    if (item.path().extension() == ".json" && holds_plan(item.path())) files.push_back(item.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) add_plan(file, catalogue, false);
}

Catalogue standard_catalogue(const std::vector<fs::path>& files) {
  std::vector<fs::path> libraries, plans;
  for (const fs::path& file : files) (file.extension() == ".json" ? plans : libraries).push_back(file);
  Catalogue catalogue = Catalogue::standard(libraries);
  for (const fs::path& folder : catalogue.folders()) add_plans(folder, catalogue);
  for (const fs::path& file : plans) add_plan(file, catalogue, true);
  return catalogue;
}

}  // namespace ricochet
