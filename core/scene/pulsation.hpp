#pragma once
#include <optional>
#include <ricochet/scene/formula.hpp>

namespace ricochet {

/// Ω > 0 (rad/s) of a formula whose t stands in sines and cosines of Ωt + ψ(x) alone, else none. These may be added,
/// multiplied, divided and raised to powers: whether it is of their first order is for the values to show.
std::optional<double> pulsation_of(const Formula& formula);

}  // namespace ricochet
