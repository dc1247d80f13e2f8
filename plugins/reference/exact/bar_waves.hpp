#pragma once
#include "chebyshev.hpp"
#include "sampled_bar.hpp"

/// \file
/// The bar that touches nothing: d'Alembert's two waves.
namespace ricochet::reference {

/// With f and g the initial displacement and velocity, even about the free end ξ = 0, odd about the fixed end ξ = L
/// (even where that is free too), and G = ∫₀ g:
///
///     u(ξ, t) = ½(f(ξ − ct) + f(ξ + ct)) + (G(ξ + ct) − G(ξ − ct))/(2c)
class BarWaves {
 public:
  BarWaves(BarFrame bar, bool other_end_fixed, Chebyshev displacement, Chebyshev velocity)
      : bar_(bar),
        sign_(other_end_fixed ? -1 : 1),
        f_(std::move(displacement)),
        slope_(f_.derivative()),
        g_(std::move(velocity)),
        G_(g_.integral()) {}

  BarPoint at(double xi, double t) const {
    const double c = bar_.speed();
    const Wave ahead = wave(xi + c * t), behind = wave(xi - c * t);
    return {0.5 * (behind.f + ahead.f) + (ahead.G - behind.G) / (2 * c),
            0.5 * (behind.slope + ahead.slope) + (ahead.g - behind.g) / (2 * c),
            0.5 * c * (ahead.slope - behind.slope) + 0.5 * (ahead.g + behind.g)};
  }

  /// ½∫ρA u_t² + ½∫EA u_x², which stays what it was, by Gauss's two points on 2000 cells.
  double energy() const {
    constexpr int cells = 2000;
    const double cell = bar_.length / cells, offset = 0.5 / std::sqrt(3.0);
    double sum = 0;
    for (int i = 0; i < cells; ++i)
      for (const double side : {-offset, offset}) {
        const double xi = (i + 0.5 + side) * cell, rate = g_(xi), strain = slope_(xi);
        sum += cell / 4 * (bar_.inertia * rate * rate + bar_.stiffness * strain * strain);
      }
    return sum;
  }

 private:
  struct Wave {
    double f = 0, slope = 0, g = 0, G = 0;
  };
  Wave wave(double xi) const {
    // Turns of 2L: each changes the sign where the other end is fixed, and adds what G gains where it is free.
    const double L = bar_.length, turns = std::round(xi / (2 * L)), within = xi - 2 * L * turns, x = std::abs(within);
    const bool odd = std::fmod(turns, 2) != 0;
    const double sign = odd ? sign_ : 1, side = within < 0 ? -1 : 1;
    return {sign * f_(x), sign * side * slope_(x), sign * g_(x),
            sign * side * G_(x) + (sign_ > 0 ? 2 * turns * G_(L) : 0)};
  }

  BarFrame bar_;
  double sign_;
  Chebyshev f_, slope_, g_, G_;
};

}  // namespace ricochet::reference
