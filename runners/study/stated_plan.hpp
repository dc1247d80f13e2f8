#pragma once
#include <filesystem>
#include <optional>
#include <ricochet/loader/catalogue.hpp>

#include "runners/study/plan_scheme.hpp"

namespace ricochet {

/// The name under which a study gives a scheme that is no plugin: {"name": "plan", "file": "my-scheme.json"}.
inline constexpr const char* stated_plan = "plan";

/// If an entry of `methods.time` states its scheme itself, by "file" (a path, relative to `folder`, the study's) or by
/// "plan" (the plan itself, as resolved studies have it, which need no file), reads the plan, registers it under its
/// own name and leaves in `entry` this name and the parameters. Within a study a name stands for one scheme: throws
/// InputError when the name is that of a plugin or of another plan among `before` (complete entries); and for whatever
/// is wrong with the plan.
std::optional<PlanSource> take_stated_plan(Json& entry, const std::string& pointer, const std::filesystem::path& folder,
                                           const Json& before, Catalogue& catalogue, Registry& registry);

/// The catalogue of this program with the plans beside its plugins: files *.json in the plugin folders that hold a plan
/// (an object with "slots" or "stages"), after all libraries, and those among `files`. One that is wrong is unusable;
/// in `files` it is a PluginError.
Catalogue standard_catalogue(const std::vector<std::filesystem::path>& files = {});
/// Adds the plans of one folder.
void add_plans(const std::filesystem::path& folder, Catalogue& catalogue);

}  // namespace ricochet
