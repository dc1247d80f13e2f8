#pragma once
#include "runners/study/study.hpp"

namespace ricochet {

/// The JSON Schema of a method that states its scheme itself: {"name": "plan", "file": …} or {"name": …, "plan": {…}},
/// with the parameters that the plan declares, which only the reader knows.
struct StatedPlanSchema {
  Json in_file, here;
  Json definitions;  ///< what both refer to by "#/$defs/NAME"
};
StatedPlanSchema stated_plan_schema();

}  // namespace ricochet
