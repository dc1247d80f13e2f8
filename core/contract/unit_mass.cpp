#include <ricochet/contract/unit_mass.hpp>

namespace ricochet {

double combined(const Combination& combination, const std::vector<double>& slots, double z, double w) {
  double sum = combination.z * z;
  if (combination.w != 0) sum += combination.w * w;
  for (std::size_t j = 0; j < combination.slots.size(); ++j) sum += combination.slots[j] * slots[j];
  return sum;
}

UnitMass::UnitMass(const StepPlan& plan, double displacement, double velocity) {
  for (const auto& [position, rate] : plan.initial) slots.push_back(position * displacement + rate * velocity);
}

double UnitMass::unknown(const Stage& stage, double force, double effort, double w) const {
  if (stage.matrix.M == 0) return 0;
  double b = effort;
  if (stage.impulse) b += stage.impulse->feed.M * w;
  for (std::size_t j = 0; j < stage.history.size(); ++j) b += stage.history[j].M * slots[j];
  for (const Level& level : stage.load) b += level.weight * force;
  return b / stage.matrix.M;
}

double UnitMass::jump(const Stage& stage, double effort) {
  return stage.impulse && stage.impulse->R.M != 0 ? effort / stage.impulse->R.M : 0.0;
}

void UnitMass::update(const Stage& stage, double z, double w) {
  std::vector<double> next;
  for (const Combination& row : stage.update) next.push_back(combined(row, slots, z, w));
  slots = std::move(next);
}

void UnitMass::advance(const std::vector<Stage>& stages, double force) {
  for (const Stage& stage : stages) update(stage, unknown(stage, force, 0));
}

}  // namespace ricochet
