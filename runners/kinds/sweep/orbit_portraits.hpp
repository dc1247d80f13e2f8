#pragma once
#include <vector>

#include "runners/kinds/sweep/orbit_rows.hpp"

namespace ricochet {

/// Numbers `portraits`: a few periods of the tip of each complete orbit, marched again from where its kept periods
/// began. Absent, with a note, where there are more orbits than a report can hold.
void add_portraits(CaseRecord& record, const ForcedScenes& scenes, const std::vector<OrbitView>& views,
                   const SectionPlan& plan);

}  // namespace ricochet
