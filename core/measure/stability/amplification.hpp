#pragma once
#include <Eigen/Core>
#include <optional>
#include <ricochet/contract/step_plan.hpp>

namespace ricochet {

/// The step of a plan on one scalar mode m q'' + c q' + k q = 0, contact open: x_{n+1} = A x_n over the slots (s × s,
/// dimensionless up to the slots' own units). Follows from the plan alone. A mode on which S vanishes gives a matrix of
/// infinities.
Eigen::MatrixXd amplification(const StepPlan& plan, double m, double c, double k);

/// ρ∞: what one step leaves of a mode whose frequency is far above 1/h, the largest |r| as hω → ∞, found on a spring
/// without mass (m = c = 0, k = 1). Roots that coincide there are known by their mean; slots that the position never
/// depends on do not count. Nothing where S vanishes on it: an explicit step.
std::optional<double> root_at_infinity(const StepPlan& plan);

}  // namespace ricochet
