#pragma once
#include <Eigen/Core>
#include <optional>
#include <ricochet/scene/formula.hpp>

namespace ricochet {

/// Ω > 0 (rad/s) of a formula whose t stands in sines and cosines of Ωt + ψ(x) alone, else none. These may be added,
/// multiplied, divided and raised to powers: whether it is of their first order is for the values to show.
std::optional<double> pulsation_of(const Formula& formula);

/// c, a and b of a load c + a sin Ωt + b cos Ωt.
struct HarmonicParts {
  Eigen::VectorXd constant, along, across;
};
/// From its values at 0, π/2Ω and π/Ω.
HarmonicParts harmonic_parts(const Eigen::VectorXd& start, const Eigen::VectorXd& quarter, const Eigen::VectorXd& half);

}  // namespace ricochet
