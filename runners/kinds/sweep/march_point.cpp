#include "runners/kinds/sweep/march_point.hpp"

#include <algorithm>

#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/orbit_scheduler.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"

namespace ricochet {
namespace {

// The scenes of a case, added as its run did until the first one that can be marched: that one chose the operator.
class PointScenes {
 public:
  PointScenes(const StudyCase& study_case, const Registry& registry)
      : pointer_(study_case.settings.at("parameter").at("pointer").get<std::string>()),
        starts_(starts_of(study_case.settings)),
        scenes_(study_case, registry) {
    for (const double value : parameter_values(study_case.settings))
      for (const bool state : {false, true})
        if (any_start(starts_, state) && scenes_.groups() == 0) scenes_.add(pointer_, value, state);
  }

  int add(double value, const std::string& start) {
    for (const StartSpec& one : starts_)
      if (one.name == start) return scenes_.add(pointer_, value, one.own_state());
    throw InputError("", "the study has no start \"" + start + "\"");
  }
  const ForcedScenes& scenes() const { return scenes_; }

 private:
  std::string pointer_;
  std::vector<StartSpec> starts_;
  ForcedScenes scenes_;
};

// Marches a lane on from one step after a strobe, sample by sample.
void march_on(Program program, const LaneSpec& lane, const LaneState& entry, const SectionPlan& plan, SampleCount count,
              const std::function<void(const PointSample&)>& use) {
  Marcher marcher(std::move(program));
  const int whole = plan.steps_per_period, origin = plan.strobe + 1, samples = std::min(count.samples, whole);
  const double h = marcher.program().h;
  marcher.set_clock(origin);
  marcher.set_lane(0, lane, entry);
  double before = 0, at = marcher.tip(0);
  for (int period = 0; period < count.periods; ++period) {
    int taken = 0;  // of this period
    // The clock of the march is turned back once per period, as in the run.
    for (int step_of_period = 1; step_of_period <= whole; ++step_of_period) {
      marcher.march(1);
      const double after = marcher.tip(0);
      // `at` stands step_of_period after the strobe; a sample for each k with step_of_period = ⌈k·whole/samples⌉.
      if (static_cast<long long>(step_of_period) * samples >= static_cast<long long>(taken + 1) * whole) {
        ++taken;
        const long long step = static_cast<long long>(period) * whole + step_of_period;
        if (step > 1)
          use({static_cast<double>(step) * h, at, (after - before) / (2 * h), step_of_period == whole ? period : -1});
      }
      before = at;
      at = after;
    }
    marcher.set_clock(origin);
  }
}

}  // namespace

void march_point(const StudyCase& study_case, const Registry& registry, const PointTask& task,
                 const std::function<void(const PointSample&)>& use) {
  PointScenes made(study_case, registry);
  const ForcedScene& scene = made.scenes()[made.add(task.parameter, task.start)];
  if (!scene.refusal.empty()) throw InputError("", scene.refusal);
  march_on(made.scenes().program(scene.group, {scene.lane}), scene.lane, task.entry,
           section_plan(study_case, made.scenes()), task.count, use);
}

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
  const CellEnd end = cell_end(orbit, options.section);
  if (end.status == "done")
    march_on(scenes.program(scenes[scheduler.task(number).scene].group, {orbit.lane}), orbit.lane, orbit.entry,
             options.section, count, use);
  return end;
}

}  // namespace ricochet
