#pragma once
#include "runners/kinds/sweep/sweep.hpp"
#include "runners/march/case_plan.hpp"

namespace ricochet {

/// How many times what `plan` predicts a part of a case takes, measured by `run` with as many steps per period as a
/// fraction of a second allows: orbits settle, or do not, as those of finer steps mostly will. 0 where that cannot be
/// told.
double rehearsed(StudyCase part, const Registry& registry, CasePlan (*plan)(const StudyCase&, const Registry&),
                 const RunSweep& run);

}  // namespace ricochet
