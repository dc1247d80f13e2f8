#pragma once
#include <cmath>

#include "sampled_bar.hpp"

/// \file
/// The bar that is stretched by its stop's distance, let go, and bounces for ever with period 3L/c.
namespace ricochet::reference {

/// u_tt = u_xx on ]0, 1[, u(1) = 0, u ≥ 0 at x = 0 with the reaction −u_x(0) ≥ 0, u(x, 0) = (1 − x)/2, u_t(x, 0) = 0.
/// Waves run at speed 1: the bar slackens on [0, 1], is pressed on the stop on [1, 2] (stress ½), stretches on [2, 3].
/// With τ = t mod 1 the fronts τ = x and τ = 1 − x bound four zones of constant strain and velocity.
struct BarBounce {
  static BarPoint at(double x, double t) {
    const double period = t - 3 * std::floor(t / 3), tau = period - std::floor(period);
    const bool passed = tau > x, returned = tau > 1 - x;
    if (period < 1) return passed ? BarPoint{(1 - tau) / 2, 0, -0.5} : BarPoint{(1 - x) / 2, -0.5, 0};
    if (period < 2) {
      if (!passed) return returned ? BarPoint{(x - 1) / 2, 0.5, 0} : BarPoint{-tau / 2, 0, -0.5};
      return returned ? BarPoint{(tau - 1) / 2, 0, 0.5} : BarPoint{-x / 2, -0.5, 0};
    }
    return returned ? BarPoint{(1 - x) / 2, -0.5, 0} : BarPoint{tau / 2, 0, 0.5};
  }
  static constexpr double energy = 0.125;
  /// ∫₀ᵗ of the reaction, which is ½ on [1, 2], [4, 5], …
  static double impulse(double t) {
    const double periods = std::floor(t / 3), within = t - 3 * periods;
    return 0.5 * (periods + std::fmin(std::fmax(within - 1, 0), 1));
  }
};

}  // namespace ricochet::reference
