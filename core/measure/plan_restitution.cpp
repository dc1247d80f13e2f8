#include <ricochet/measure/plan_restitution.hpp>
#include <ricochet/measure/unit_mass.hpp>

namespace ricochet {

std::optional<double> plan_restitution(const StepPlan& plan, double h) {
  // From two steps and a bit above a stop at 0, downwards at one unit per second.
  UnitMass mass(plan, 2.3 * h, -1);
  mass.step(plan.start, 0, true);
  bool measured = false;  // by the steps: the start may see what they do not
  for (int n = 0; n < 12; ++n) measured = mass.step(plan.stages, 0, true) || measured;
  if (!measured) return std::nullopt;
  // The rebound over one more step, whatever the scheme keeps as its velocity.
  const double before = mass.slots[0];
  mass.step(plan.stages, 0, true);
  return (mass.slots[0] - before) / h;
}

}  // namespace ricochet
