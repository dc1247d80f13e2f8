#include <cmath>
#include <ricochet/measure/unit_mass.hpp>
#include <ricochet/measure/velocity_offset.hpp>

namespace ricochet {

double velocity_offset(const StepPlan& plan) {
  constexpr int few = 4;
  UnitMass mass(plan, 0, 0);
  mass.step(plan.start, 1, false);
  for (int n = 0; n < few; ++n) mass.step(plan.stages, 1, false);
  const double once = combined(plan.velocity, mass.slots);
  mass.step(plan.stages, 1, false);
  // One step more adds h: that is the scale.
  const double h = combined(plan.velocity, mass.slots) - once, steps = few + (plan.start_advances ? 1 : 0);
  const double offset = h > 0 ? once / h - steps : 0;
  return std::abs(offset + 0.5) < 0.25 ? -0.5 : 0.0;
}

}  // namespace ricochet
