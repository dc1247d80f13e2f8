#include "runners/kinds/basins/march_cell.hpp"

#include <ricochet/measure/orbits/judge_orbit.hpp>

#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"

namespace ricochet {

CellEnd march_cell(const StudyCase& study_case, const Registry& registry, CellPlace cell, SampleCount count,
                   const std::function<void(const PointSample&)>& use) {
  CellScenes made(study_case, registry);
  made.begin();
  CellScenes::Prepared prepared = made.prepare(cell.column, cell.row);
  if (!prepared.refusal.empty()) return refused_end(prepared.refusal);
  const ForcedScenes& scenes = made.scenes();
  ScheduleOptions options;
  options.section = section_plan(study_case, scenes);
  OrbitScheduler scheduler(scenes, options);
  const int number = scheduler.add(std::move(prepared.task));
  const std::atomic<bool> stop = false;
  scheduler.run(stop, [](const MarchedOrbits&) {});
  const Orbit& orbit = scheduler.orbit(number);
  Orbit ended = orbit;
  keep_end(ended, options.section);
  const CellEnd end = cell_end(ended);
  if (end.status == "done") march_on(scenes, scheduler.task(number).scene, orbit, options.section, count, use);
  return end;
}

}  // namespace ricochet
