#include <cmath>
#include <ricochet/measure/velocity_offset.hpp>

namespace ricochet {

double velocity_offset(const StepPlan& plan) {
  const std::size_t slots = plan.slots.size();
  std::vector<double> x(slots, 0.0), next(slots);
  const auto apply = [&](const std::vector<Stage>& stages) {
    for (const Stage& stage : stages) {
      double b = 0, z = 0;
      for (std::size_t j = 0; j < stage.history.size(); ++j) b += stage.history[j].M * x[j];
      for (const Level& level : stage.load) b += level.weight;
      if (stage.matrix.M != 0) z = b / stage.matrix.M;
      for (std::size_t j = 0; j < slots; ++j) {
        const Combination& update = stage.update[j];
        next[j] = update.z * z;
        for (std::size_t i = 0; i < update.slots.size(); ++i) next[j] += update.slots[i] * x[i];
      }
      x = next;
    }
  };
  apply(plan.start);
  constexpr int few = 4;
  for (int n = 0; n < few; ++n) apply(plan.stages);
  double twice = 0, once = 0;
  for (std::size_t j = 0; j < plan.velocity.slots.size(); ++j) once += plan.velocity.slots[j] * x[j];
  apply(plan.stages);
  for (std::size_t j = 0; j < plan.velocity.slots.size(); ++j) twice += plan.velocity.slots[j] * x[j];
  // One step more adds h: that is the scale.
  const double h = twice - once, steps = few + (plan.start_advances ? 1 : 0);
  const double offset = h > 0 ? once / h - steps : 0;
  return std::abs(offset + 0.5) < 0.25 ? -0.5 : 0.0;
}

}  // namespace ricochet
