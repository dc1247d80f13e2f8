#pragma once
#include <ricochet/contract/registry.hpp>

#include "runners/study/json_place.hpp"

namespace ricochet {

/// What a plan says of itself: name, summary, text, source and parameters, as a plugin registers them; the keys of the
/// whole plan are checked. Throws InputError.
PluginManual read_plan_manual(const JsonPlace& plan);

}  // namespace ricochet
