#pragma once
#include <ricochet/contract/step_plan.hpp>
#include <vector>

namespace ricochet {

/// A free unit mass (M = 1, C = K = 0) that a plan marches: what the plan's numbers mean, apart from any structure.
struct UnitMass {
  std::vector<double> slots;

  /// From displacement and velocity, before the start rule.
  UnitMass(const StepPlan& plan, double displacement, double velocity);
  /// The unknown of a stage under a constant force and a weighted effort Σ π_k p₋ₖ (N), fed with w; 0 where S has no M.
  double unknown(const Stage& stage, double force, double effort, double w = 0) const;
  /// w of a stage under the effort ι p (N); 0 where it has no impulse, or R no M.
  static double jump(const Stage& stage, double effort);
  /// The slots after the stage, with its unknowns.
  void update(const Stage& stage, double z, double w = 0);
  /// Stages under a constant force and without contact.
  void advance(const std::vector<Stage>& stages, double force);
};

/// Σ_j c_j x_j + c_z z + c_w w.
double combined(const Combination& combination, const std::vector<double>& slots, double z = 0, double w = 0);

}  // namespace ricochet
