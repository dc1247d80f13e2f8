#include <ricochet/measure/orbits/section_march.hpp>

namespace ricochet {

StartedOrbits start_orbits(Program program, const SectionPlan& plan) {
  Marcher marcher(std::move(program));
  marcher.start();
  marcher.march(plan.strobe + 1 + plan.steps_per_period - marcher.step());
  StartedOrbits started;
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    started.states.push_back(marcher.lane_state(lane));
    started.ends.push_back(marcher.status(lane).end);
  }
  return started;
}

}  // namespace ricochet
