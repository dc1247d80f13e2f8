#pragma once
#include <ricochet/contract/step_plan.hpp>
#include <vector>

namespace ricochet {

/// A free unit mass (M = 1, C = K = 0) that a plan marches: what the plan's numbers mean, apart from any structure.
struct UnitMass {
  std::vector<double> slots;

  /// From displacement and velocity, before the start rule.
  UnitMass(const StepPlan& plan, double displacement, double velocity);
  /// The stages of a step under a constant force (N); with `stop`, a rigid one below at 0. Returns whether an effort of
  /// the stop could have moved an impact measure.
  bool step(const std::vector<Stage>& stages, double force, bool stop);
};

/// Σ_j c_j x_j + c_z z.
double combined(const Combination& combination, const std::vector<double>& slots, double z = 0);

}  // namespace ricochet
