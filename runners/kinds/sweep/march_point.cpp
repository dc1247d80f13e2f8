#include "runners/kinds/sweep/march_point.hpp"

#include <algorithm>

#include "runners/kinds/sweep/orbit_rows.hpp"
#include "runners/kinds/sweep/tip_march.hpp"
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

}  // namespace

void march_on(const ForcedScenes& scenes, int scene, const Orbit& orbit, const SectionPlan& plan, SampleCount count,
              const std::function<void(const PointSample&)>& use) {
  TipMarch tips(scenes.program(scenes[scene].group, {orbit.lane}), {&orbit}, plan);
  const int whole = plan.steps_per_period, samples = std::min(count.samples, whole);
  for (int period = 0; period < count.periods; ++period) {
    int taken = 0;  // of this period
    tips.march(whole, [&](std::size_t, long long step, double displacement, double velocity) {
      // A sample for each k with step_of_period = ⌈k·whole/samples⌉.
      const long long step_of_period = step - static_cast<long long>(period) * whole;
      if (step_of_period * samples < static_cast<long long>(taken + 1) * whole) return;
      ++taken;
      use({static_cast<double>(step) * tips.h(), displacement, velocity, step_of_period == whole ? period : -1});
    });
    tips.turn_back();
  }
}

void march_point(const StudyCase& study_case, const Registry& registry, const PointTask& task,
                 const std::function<void(const PointSample&)>& use) {
  PointScenes made(study_case, registry);
  const int scene = made.add(task.parameter, task.start);
  const ForcedScene& found = made.scenes()[scene];
  if (!found.refusal.empty()) throw InputError("", found.refusal);
  Orbit orbit;
  orbit.lane = found.lane;
  orbit.entry = task.entry;
  march_on(made.scenes(), scene, orbit, section_plan(study_case, made.scenes()), task.count, use);
}

}  // namespace ricochet
