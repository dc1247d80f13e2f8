#pragma once
#include <ricochet/contract/step_plan.hpp>

namespace ricochet {

/// What a scheme may know of the problem when it writes its plan.
struct ProblemFacts {
  int dofs = 0;
  int mass_kernel_dimension = 0;  ///< dim Ker M; 0 when the mass is regular
  bool damped = false;            ///< C ≠ 0
  bool contact = false;           ///< a law other than `none` and at least one stop
};

/// A time scheme: numbers, never a loop.
class TimeScheme {
 public:
  virtual ~TimeScheme() = default;
  /// The step as data for the step length h (s), or a sentence that says why it does not apply.
  virtual PlanOrRefusal plan(double h, const ProblemFacts& facts) const = 0;
};

}  // namespace ricochet
