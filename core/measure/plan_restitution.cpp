#include <algorithm>
#include <ricochet/measure/plan_restitution.hpp>
#include <vector>

namespace ricochet {
namespace {

double combine(const Combination& c, const std::vector<double>& x, double z) {
  double sum = c.z * z;
  for (std::size_t j = 0; j < c.slots.size(); ++j) sum += c.slots[j] * x[j];
  return sum;
}

}  // namespace

std::optional<double> plan_restitution(const StepPlan& plan, double h) {
  // From half a step and a bit above a stop at 0, downwards at one unit per second.
  const double start = 2.3 * h;
  std::vector<double> x, next(plan.slots.size());
  for (const auto& [position, velocity] : plan.initial) x.push_back(position * start - velocity);
  bool measured = false;
  const auto step = [&](const std::vector<Stage>& stages) {
    for (const Stage& stage : stages) {
      double b = 0, z = 0;
      const double S = stage.matrix.M;
      for (std::size_t j = 0; j < stage.history.size(); ++j) b += stage.history[j].M * x[j];
      if (S != 0) z = b / S;
      const double reach = stage.impact && S != 0 ? stage.impact->value.z / S : 0.0;
      if (reach > 0) {
        measured = true;
        const double y = combine(stage.impact->value, x, z);
        double lower = 0;
        bool closed = true;
        if (const auto& gate = stage.impact->gate) {
          const double approach = combine(gate->approach, x, 0);
          closed = combine(gate->predictor, x, 0) <= 0;
          lower = approach > 0 ? -approach : -gate->restitution * approach;
        }
        if (closed && y < lower) z += (lower - y) / reach / S;
      }
      for (std::size_t j = 0; j < x.size(); ++j) next[j] = combine(stage.update[j], x, z);
      x = next;
    }
  };
  step(plan.start);
  measured = false;  // the start may see what the steps do not
  for (int n = 0; n < 12; ++n) step(plan.stages);
  if (!measured) return std::nullopt;
  // The rebound over one more step, whatever the scheme keeps as its velocity.
  const double before = x[0];
  step(plan.stages);
  return (x[0] - before) / h;
}

}  // namespace ricochet
