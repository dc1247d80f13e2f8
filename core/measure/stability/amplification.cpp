#include <algorithm>
#include <limits>
#include <ricochet/contract/stage_facts.hpp>
#include <ricochet/measure/stability/amplification.hpp>
#include <ricochet/measure/stability/step_map.hpp>

namespace ricochet {

Eigen::MatrixXd amplification(const StepPlan& plan, double m, double c, double k) {
  const auto slots = static_cast<Eigen::Index>(plan.slots.size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(slots, slots);
  for (const Stage& stage : plan.stages) {
    const double s = stage.matrix.M * m + stage.matrix.C * c + stage.matrix.K * k;
    Eigen::RowVectorXd unknown = Eigen::RowVectorXd::Zero(slots);
    if (stage.matrix.M != 0 || stage.matrix.C != 0 || stage.matrix.K != 0) {
      if (s == 0) return Eigen::MatrixXd::Constant(slots, slots, std::numeric_limits<double>::infinity());
      for (std::size_t j = 0; j < stage.history.size(); ++j) {
        const OperatorWeights& w = stage.history[j];
        unknown[static_cast<Eigen::Index>(j)] = (w.M * m + w.C * c + w.K * k) / s;
      }
    }
    Eigen::MatrixXd step = Eigen::MatrixXd::Zero(slots, slots);
    for (Eigen::Index j = 0; j < slots; ++j) {
      const Combination& update = stage.update[static_cast<std::size_t>(j)];
      for (std::size_t i = 0; i < update.slots.size(); ++i) step(j, static_cast<Eigen::Index>(i)) = update.slots[i];
      step.row(j) += update.z * unknown;
    }
    whole = step * whole;
  }
  return whole;
}

namespace {

// Slots that the position depends on, after however many steps: others, kept for an energy or for who reads them, have
// roots of their own that are none of the motion.
std::vector<Eigen::Index> moving_slots(const StepPlan& plan) {
  const Eigen::MatrixXd step = amplification(plan, 1, 0.7, 1.3);  // any mode: what is zero is so by structure
  std::vector<Eigen::Index> found = {0};
  for (std::size_t k = 0; k < found.size(); ++k)
    for (Eigen::Index j = 0; j < step.cols(); ++j)
      if (step(found[k], j) != 0 && std::find(found.begin(), found.end(), j) == found.end()) found.push_back(j);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::optional<double> root_at_infinity(const StepPlan& plan) {
  const double h = step_of(plan);
  const Eigen::MatrixXd step = amplification(plan, 0, 0, 1);
  // In like units: roots that coincide are lost in slots whose sizes differ by 1/h². Largest first; none where the step
  // is not finite.
  const Eigen::MatrixXd like = h > 0 ? in_metres(step, plan, h, 1) : step;
  const std::vector<Eigen::Index> moving = moving_slots(plan);
  const std::vector<Root> roots = step_roots(like(moving, moving), false);
  if (roots.empty()) return std::nullopt;
  // Zero may be a root of all slots that the spring has, four times in a chain: known to the fourth root of round-off.
  constexpr double nothing = 1e-3;
  const double root = std::abs(roots.front().value);
  return root < nothing ? 0 : root;
}

}  // namespace ricochet
