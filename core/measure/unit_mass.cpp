#include <ricochet/measure/unit_mass.hpp>

namespace ricochet {

double combined(const Combination& combination, const std::vector<double>& slots, double z) {
  double sum = combination.z * z;
  for (std::size_t j = 0; j < combination.slots.size(); ++j) sum += combination.slots[j] * slots[j];
  return sum;
}

UnitMass::UnitMass(const StepPlan& plan, double displacement, double velocity) {
  for (const auto& [position, rate] : plan.initial) slots.push_back(position * displacement + rate * velocity);
}

bool UnitMass::step(const std::vector<Stage>& stages, double force, bool stop) {
  bool measured = false;
  std::vector<double> next(slots.size());
  for (const Stage& stage : stages) {
    double b = 0, z = 0;
    const double S = stage.matrix.M;
    for (std::size_t j = 0; j < stage.history.size(); ++j) b += stage.history[j].M * slots[j];
    for (const Level& level : stage.load) b += level.weight * force;
    if (S != 0) z = b / S;
    const double reach = stop && stage.impact && S != 0 ? stage.impact->value.z / S : 0.0;
    if (reach > 0) {
      measured = true;
      const double y = combined(stage.impact->value, slots, z);
      double lower = 0;
      bool closed = true;
      if (const auto& gate = stage.impact->gate) {
        const double approach = combined(gate->approach, slots);
        closed = combined(gate->predictor, slots) <= 0;
        lower = approach > 0 ? -approach : -gate->restitution * approach;
      }
      if (closed && y < lower) z += (lower - y) / reach / S;
    }
    for (std::size_t j = 0; j < slots.size(); ++j) next[j] = combined(stage.update[j], slots, z);
    slots = next;
  }
  return measured;
}

}  // namespace ricochet
