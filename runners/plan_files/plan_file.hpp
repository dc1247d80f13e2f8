#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <ricochet/loader/catalogue.hpp>
#include <string>

#include "runners/json/json_text.hpp"

/// \file
/// A time scheme without C++: slots, stages, rows and facts of a StepPlan as formulas in h and named parameters, in
/// JSON (plugins/plan-files.md). It is checked when it is read, and is then a method like any other.
namespace ricochet {

/// A plan as it was written, and where: a file of its own, or a value of a study.
struct PlanSource {
  Json plan;
  std::filesystem::path file;  ///< "" for a plan that stands in a study
  std::string text;            ///< of the file, for lines
  std::string pointer;         ///< of the plan within its document

  /// "FILE:LINE: at /stages/0/matrix: what is wrong", or without file and line where there is none.
  std::string explain(const InputError& error) const;
};

/// Whether a file beside plugins, or among those of a command, is a plan and no library.
bool is_plan_file(const std::filesystem::path& file);

/// Reads a file. Throws InputError, pointer "", whose text names the file: it cannot be read, or is no JSON.
PlanSource read_plan_file(const std::filesystem::path& file);

/// Checks a whole plan, every key and every formula, and tells what it says of itself. Where all parameters have
/// defaults, the plan must be well-formed with these and h = 1 ms. The problem is then regular and damped, with
/// contact. Throws InputError with pointers into the document.
PluginManual check_plan_source(const PlanSource& source);

/// Checks and registers it as a time scheme that comes from `source.file`. Throws InputError.
void register_plan(const PlanSource& source, Registry& registry);

/// The name under which a study gives a scheme that is no plugin: {"name": "plan", "file": "my-scheme.json"}.
inline constexpr const char* stated_plan = "plan";

/// An entry of `methods.time` may state its scheme itself. It does by "file", a path relative to `folder`, the study's,
/// or by "plan", as resolved studies have it. It may also have the name of a plan beside the plugins. This reads the
/// plan once, registers it under its own name, and leaves in `entry` this name and the parameters. So what a study runs
/// and keeps is what was read here, whatever becomes of the file. Within a study a name stands for one scheme. Throws
/// InputError when the name is that of a library's method or of another plan among `before` (complete entries). Throws
/// it for whatever is wrong with the plan, too.
std::optional<PlanSource> take_stated_plan(Json& entry, const std::string& pointer, const std::filesystem::path& folder,
                                           const Json& before, Catalogue& catalogue, Registry& registry);

/// What a person should know of libraries that the catalogue opens goes to stderr.
void tell_remarks(Catalogue& catalogue);

/// The catalogue of this program with plans after all libraries. These are the files *.json in the plugin folders that
/// hold a plan (an object with "slots" or "stages"), and those among `files`. One that is wrong is unusable; in `files`
/// it is a PluginError.
Catalogue standard_catalogue(const std::vector<std::filesystem::path>& files = {});
/// Where methods were looked for, a sentence: the folders, which of them are none, the files of --plugin.
std::string where_looked(const Catalogue& catalogue);
/// Adds the plans of one folder.
void add_plans(const std::filesystem::path& folder, Catalogue& catalogue);

/// The JSON Schema of a method that states its scheme itself: {"name": "plan", "file": …} or {"name": …, "plan": {…}}.
/// Any parameters may stand beside: only the reader knows which the plan declares.
struct StatedPlanSchema {
  Json in_file, here;
  Json definitions;  ///< what both refer to by "#/$defs/NAME"
};
StatedPlanSchema stated_plan_schema();

}  // namespace ricochet
