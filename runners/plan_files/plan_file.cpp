#include "runners/plan_files/plan_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/scene/files/text_file.hpp>

#include "runners/json/json_text.hpp"
#include "runners/table/text.hpp"

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
  const std::string name = file->get<std::string>();
  if (!is_plain(name))
    throw InputError(here, "control characters, or bytes that are no UTF-8; expected the path of a plan without them");
  const fs::path path = (folder / name).lexically_normal();
  try {
    return read_plan_file(path);
  } catch (const InputError& error) {
    // What a file says that lies elsewhere is not shown.
    if (!lies_within(folder.empty() ? "." : folder, path) && fs::exists(path))
      throw InputError(here, fmt::format("\"{}\" lies outside the folder of the study, and is no plan that can be read",
                                         shortened(name)));
    throw InputError(here, error.what());
  }
}

// What states the plan of an entry: its keys, or the plan beside the plugins whose name it has. Nothing for a library.
std::optional<PlanSource> find_source(const Json& entry, const std::string& pointer, const fs::path& folder,
                                      const Catalogue& catalogue) {
  if (states_plan(entry)) return source_of(entry, pointer, folder);
  const auto name = entry.find("name");
  if (name == entry.end() || !name->is_string()) return std::nullopt;
  const fs::path* const provider = catalogue.provider(Role::time, name->get<std::string>());
  if (!provider || !is_plan_file(*provider)) return std::nullopt;
  try {
    return read_plan_file(*provider);
  } catch (const InputError& error) {
    throw InputError(pointer_to(pointer, "name"), error.what());
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
  const bool plan_file = provider != all.end() && is_plan_file(provider->file);
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
  if (std::error_code ignored; !fs::is_regular_file(file, ignored)) return false;
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

bool is_plan_file(const fs::path& file) {
  return file.extension() == ".json";
}

std::optional<PlanSource> take_stated_plan(Json& entry, const std::string& pointer, const fs::path& folder,
                                           const Json& before, Catalogue& catalogue, Registry& registry) {
  std::optional<PlanSource> found = find_source(entry, pointer, folder, catalogue);
  if (!found) return std::nullopt;
  PlanSource& source = *found;
  const std::string where =
      source.file.empty() ? source.pointer : pointer_to(pointer, entry.contains(file_key) ? file_key : "name");
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
  return found;
}

void add_plans(const fs::path& folder, Catalogue& catalogue) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(folder, ignored))
    if (is_plan_file(item.path()) && holds_plan(item.path())) files.push_back(item.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) add_plan(file, catalogue, false);
}

std::string where_looked(const Catalogue& catalogue) {
  const std::vector<fs::path>&folders = catalogue.folders(), missing = catalogue.missing_folders();
  const auto among = [](const std::vector<fs::path>& all, const fs::path& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  };
  std::string text;
  for (const fs::path& folder : folders)
    text +=
        (text.empty() ? "looked in " : ", ") + folder.string() + (among(missing, folder) ? " (no such folder)" : "");
  std::vector<fs::path> single;
  const auto add = [&](const fs::path& file) {
    if (!among(folders, file.parent_path()) && !among(single, file)) single.push_back(file);
  };
  for (const Provided& method : catalogue.provided()) add(method.file);
  for (const Unusable& file : catalogue.unusable()) add(file.file);
  for (const fs::path& file : single) text += ", " + file.string();
  return text + "; RICOCHET_PLUGIN_PATH adds folders, --plugin a file";
}

void tell_remarks(Catalogue& catalogue) {
  catalogue.on_remark([](const std::string& remark) { std::cerr << "ricochet: " << remark << "\n"; });
}

Catalogue standard_catalogue(const std::vector<fs::path>& files) {
  std::vector<fs::path> libraries, plans;
  for (const fs::path& file : files) (is_plan_file(file) ? plans : libraries).push_back(file);
  Catalogue catalogue = Catalogue::standard(libraries);
  tell_remarks(catalogue);
  for (const fs::path& folder : catalogue.folders()) add_plans(folder, catalogue);
  for (const fs::path& file : plans) add_plan(file, catalogue, true);
  return catalogue;
}

namespace {

Json described(Json schema, const char* text) {
  schema["description"] = text;
  return schema;
}

Json reference(const char* name) {
  return {{"$ref", std::string("#/$defs/") + name}};
}
Json number() {
  return {{"type", Json::array({"number", "string"})}};
}
Json truth() {
  return {{"type", Json::array({"boolean", "string"})}};
}
Json optional_number() {
  return {{"type", Json::array({"number", "string", "null"})}};
}
Json text() {
  return {{"type", "string"}, {"minLength", 1}};
}
Json list(const Json& items) {
  return {{"type", "array"}, {"items", items}};
}
// Keys that the plan makes up.
Json named(const Json& values) {
  return {{"type", "object"}, {"additionalProperties", values}};
}
Json closed(const Json& properties, const std::vector<std::string>& required) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}, {"patternProperties", {{"^//", true}}}};
  schema["properties"] = properties;
  if (!required.empty()) schema["required"] = required;
  return schema;
}
/// A string, or what `otherwise` says.
Json or_formula(Json otherwise) {
  return {{"if", {{"type", "string"}}}, {"then", true}, {"else", std::move(otherwise)}};
}
Json combination() {
  return reference("plan-combination");
}
Json matrices() {
  return reference("plan-matrices");
}

Json reading() {
  return closed({{"displacement", described(combination(), "g, where the law sees the contact point.")},
                 {"bound", described(named(number()), "Levels of the stop in g; derived when left out.")},
                 {"rate", described(combination(), "u, for laws with damping.")},
                 {"rate_bound", described(named(number()), "Levels of the stop's rate.")},
                 {"effort", described(list(number()), "π₀, π₁, …")},
                 {"impulse", described(number(), "ι of R w = ι Hᵀp; 1 when left out.")},
                 {"before", described(combination(), "g⁻, the displacement one step before.")},
                 {"before_bound", described(named(number()), "Levels of the stop in g⁻.")}},
                {"displacement"});
}

Json compliance() {
  Json all = Json::object();
  for (int k = 0; k < evaluations; ++k)
    all[evaluation_word(static_cast<Evaluation>(k))] =
        described(reference("plan-reading"), "What laws that read so are given.");
  return closed(all, {});
}

Json impact() {
  const Json gate = closed({{"predictor", described(combination(), "The position that closes a stop.")},
                            {"predictor_bound", described(named(number()), "Levels of the stop in it.")},
                            {"approach", described(combination(), "The velocity that rebounds.")},
                            {"approach_bound", described(named(number()), "Levels of the stop's rate in it.")},
                            {"restitution", described(number(), "e.")}},
                           {"predictor", "approach"});
  return closed({{"value", described(combination(), "y, what rigid laws keep between the stops.")},
                 {"bound", described(named(number()), "Levels of the stop in y; derived when left out.")},
                 {"gate", described(gate, "For a measure at velocity level.")},
                 {"effort", described(list(number()), "π₀, π₁, …")},
                 {"restores", described(number(), "How many stages before lies the one whose work is given back.")},
                 {"impulse", described(number(), "ι of R w = ι Hᵀp; 1 when left out.")}},
                {"value"});
}

Json term(const char* value, const char* meaning) {
  return closed({{"matrix", described({{"enum", {"M", "K"}}}, "Whose norm it is.")},
                 {"coefficient", described(number(), "Its factor.")},
                 {value, described(combination(), meaning)}},
                {"matrix", "coefficient", value});
}

Json stage() {
  const Json work = closed({{"displacement", described(combination(), "s.")},
                            {"rate", described(combination(), "r; none where nothing is damped.")},
                            {"load", described(named(number()), "F̄.")},
                            {"effort", described(list(number()), "p̄.")},
                            {"impulse", described(number(), "Weight of ι p in p̄, besides; 0 when left out.")},
                            {"support", described(named(number()), "What the stops move by; derived when left out.")}},
                           {"displacement"});
  const Json impulse = closed({{"R", described(matrices(), "R of R w = ι Hᵀp.")},
                               {"feed", described(matrices(), "What of w enters the equation of z.")}},
                              {"R"});
  return closed({{"matrix", described(matrices(), "S; none: no solve.")},
                 {"history", described(named(matrices()), "Rows of b by slot.")},
                 {"load", described(named(number()), "Weights of F by level.")},
                 {"impulse", described(impulse, "A second unknown w, of the effort alone.")},
                 {"impact", described(impact(), "For rigid laws.")},
                 {"compliance", described(compliance(), "For compliant laws, by how they read.")},
                 {"update", described(named(combination()), "What becomes of the slots; others stay.")},
                 {"work", described(work, "The balance of energy.")},
                 {"loss", described(list(term("value", "What is squared.")), "What the scheme dissipates.")}},
                {"update"});
}

Json plan() {
  const Json parameter = closed(
      {{"default", described({{"type", Json::array({"number", "boolean"})}}, "None: required.")},
       {"range", described({{"type", Json::array({"array", "string"})}}, "[0, 1], \"]0, 1[\".")},
       {"unit", described(text(), "SI; \"1\" without one.")},
       {"text", described(text(), "One sentence.")},
       {"type", described({{"enum", {"number", "integer", "boolean"}}}, "What it is.")},
       {"role", described({{"enum", {"restitution", "stiffness"}}}, "What it stands for, where others need to know.")}},
      {});
  const Json refusal = closed({{"when", described(truth(), "The formula that decides.")},
                               {"because", described(text(), "Why, and what to do.")}},
                              {"when", "because"});
  const Json facts =
      closed({{"order", described(number(), "In h, without contact.")},
              {"contact_order", described(optional_number(), "In h, at rigid stops; null: not known.")},
              {"restitution", described({{"enum", {"exact", "asymptotic", "ignored"}}}, "Whether e is kept.")},
              {"needs_regular_mass", described(truth(), "Whether a singular mass is out.")},
              {"stability_limit", described(optional_number(), "Largest stable h·ω; null: none.")},
              {"contact_never_gains", described(truth(), "Whether contact never adds energy.")}},
             {"order"});
  const Json pair = {{"type", "array"}, {"items", number()}, {"minItems", 2}, {"maxItems", 2}};
  const Json let = {{"type", Json::array({"number", "string", "object"})}};
  return closed({{"name", described(text(), "What tables call the scheme.")},
                 {"summary", described(text(), "One line.")},
                 {"text", described(text(), "One paragraph.")},
                 {"source", described(text(), "Author, year, equation.")},
                 {"parameters", described(named(parameter), "By name.")},
                 {"let", described(named(let), "Named formulas, each may use those before it.")},
                 {"refuse", described(list(refusal), "When the scheme does not apply.")},
                 {"slots", described(named(pair), "Weights of q₀ and v₀ before the start.")},
                 {"start", described(list(reference("plan-stage")), "Stages applied once.")},
                 {"start_advances", described(truth(), "Whether the start moves time by h.")},
                 {"stages", described(list(reference("plan-stage")), "Of a step.")},
                 {"energy", described(list(term("of", "What is squared, slots after the step.")), "Of the scheme.")},
                 {"velocity", described(combination(), "Of slots after the step; the slot v when left out.")},
                 {"facts", described(facts, "What the scheme declares of itself.")}},
                {"name", "slots", "stages", "facts"});
}

Json entry(const Json& properties, const std::vector<std::string>& required, const char* text) {
  return {{"type", "object"},
          {"title", "plan"},
          {"description", text},
          {"required", required},
          {"allOf", Json::array({{{"properties", properties}}})}};
}

}  // namespace

StatedPlanSchema stated_plan_schema() {
  StatedPlanSchema schema;
  schema.in_file = entry({{"name", {{"enum", {"plan"}}}}, {"file", text()}}, {"name", "file"},
                         "A scheme stated in a file, relative to the study.");
  schema.here = entry({{"name", text()}, {"plan", reference("plan")}}, {"name", "plan"}, "A scheme stated here.");
  schema.definitions = {{"plan", plan()},
                        {"plan-stage", stage()},
                        {"plan-reading", reading()},
                        {"plan-combination", or_formula(named(number()))},
                        {"plan-matrices", or_formula(closed({{"M", number()}, {"C", number()}, {"K", number()}}, {}))}};
  return schema;
}

}  // namespace ricochet
