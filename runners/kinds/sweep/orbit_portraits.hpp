#pragma once
#include <vector>

#include "runners/kinds/sweep/orbit_rows.hpp"

namespace ricochet {

/// Numbers `portraits`: a few periods of the tip of each complete orbit, marched again from where its kept periods
/// began. Absent, with a note, where there are more orbits than a report can hold.
void add_portraits(CaseRecord& record, const ForcedScenes& scenes, const std::vector<OrbitView>& views,
                   const SectionPlan& plan);

/// One orbit from `entry` (one step after a strobe), `periods` periods, `samples` per period: t from the strobe (s),
/// tip displacement (m) and velocity (m/s, over two steps).
struct Portrait {
  std::vector<double> time, displacement, velocity;
};
std::vector<Portrait> march_portraits(Program program, const std::vector<const Orbit*>& orbits, const SectionPlan& plan,
                                      int periods, int samples);

}  // namespace ricochet
