#pragma once
#include <optional>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

/// A spring behind a stop and the mass that it turns back.
struct ContactSpring {
  double stiffness = 0, mass = 0;  ///< κ, N/m; m, kg
  double pulsation = 0;            ///< rad/s, of the mass on it and on the structure behind it
};

/// What a spring κ behind the last point of contact turns back: the mode that has most of its energy in that spring,
///
///     M φ = μ (K + κ hᵀh) φ,   φᵀ(K + κ hᵀh) φ = 1,   κ (h φ)² largest:   m = κ μ,   ω = 1/√μ,
///
/// a dense problem of n dofs. Nothing where it has no points, no modes are found, or that one has no mass.
std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness);

}  // namespace ricochet
