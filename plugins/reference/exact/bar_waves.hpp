#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <ricochet/contract/reference.hpp>
#include <vector>

namespace ricochet::reference {

/// A smooth function on [0, L] as Σ c_k T_k(2x/L − 1), to round-off: with its derivative and its integral.
class Chebyshev {
 public:
  /// None where 513 points do not reach 10⁻¹³ of the largest value: the function has a kink, or worse.
  static std::optional<Chebyshev> of(const std::function<double(double)>& function, double length) {
    for (int n = 16; n <= 512; n *= 2) {
      Chebyshev fit;
      fit.length_ = length;
      std::vector<double> values;
      double largest = 0;
      for (int j = 0; j <= n; ++j) {
        values.push_back(function(length * (1 + std::cos(M_PI * j / n)) / 2));
        largest = std::max(largest, std::abs(values.back()));
      }
      for (int k = 0; k <= n; ++k) {
        double sum = 0;
        for (int j = 0; j <= n; ++j) {
          const double end = j == 0 || j == n ? 0.5 : 1;
          sum += end * values[static_cast<std::size_t>(j)] * std::cos(M_PI * j * k / n);
        }
        fit.terms_.push_back((k == 0 || k == n ? 1.0 : 2.0) * sum / n);
      }
      double tail = 0;
      for (int k = n - n / 4; k <= n; ++k) tail = std::max(tail, std::abs(fit.terms_[static_cast<std::size_t>(k)]));
      if (!(largest < INFINITY)) return std::nullopt;
      if (tail > 1e-13 * largest) continue;
      while (fit.terms_.size() > 1 && std::abs(fit.terms_.back()) <= 1e-15 * largest) fit.terms_.pop_back();
      return fit;
    }
    return std::nullopt;
  }

  double operator()(double x) const {
    const double z = 2 * x / length_ - 1;
    double last = 0, before = 0;
    for (std::size_t k = terms_.size(); k-- > 1;) {
      const double next = 2 * z * last - before + terms_[k];
      before = last;
      last = next;
    }
    return z * last - before + terms_[0];
  }

  Chebyshev derivative() const {
    Chebyshev result;
    result.length_ = length_;
    const std::size_t n = terms_.size();
    result.terms_.assign(n, 0);
    for (std::size_t k = n - 1; k >= 1; --k)
      result.terms_[k - 1] = (k + 1 < n ? result.terms_[k + 1] : 0) + 2 * static_cast<double>(k) * terms_[k];
    result.terms_[0] /= 2;
    for (double& term : result.terms_) term *= 2 / length_;
    return result;
  }

  /// ∫₀ˣ
  Chebyshev integral() const {
    Chebyshev result;
    result.length_ = length_;
    const std::size_t n = terms_.size();
    const auto term = [&](std::size_t k) { return k < n ? terms_[k] : 0; };
    result.terms_.assign(n + 1, 0);
    for (std::size_t k = 1; k <= n; ++k)
      result.terms_[k] = length_ / 2 * ((k == 1 ? 2 : 1) * term(k - 1) - term(k + 1)) / (2 * static_cast<double>(k));
    result.terms_[0] = -result(0);
    return result;
  }

 private:
  double length_ = 1;
  std::vector<double> terms_;
};

/// Displacement, strain and velocity at one place of a bar.
struct BarPoint {
  double displacement = 0, strain = 0, velocity = 0;
};

/// A bar seen from its free end: x there is `from_tip` (m).
struct BarFrame {
  double length = 1, stiffness = 1, inertia = 1;  ///< m, N (EA), kg/m (ρA)
  bool tip_left = true;                           ///< the tip is x = 0, else x = L
  double speed() const { return std::sqrt(stiffness / inertia); }
  double from_tip(double x) const { return tip_left ? x : length - x; }
  /// Strain in x, from strain in the distance to the tip.
  double strain(double towards) const { return tip_left ? towards : -towards; }
};

/// Fills tip and fields from `point(distance to the tip, t)`.
template <class Point>
void sample_bar(const BarFrame& bar, const SampleGrid& grid, const Point& point, SampledMotion& motion) {
  for (const double t : grid.times) {
    const BarPoint tip = point(0.0, t);
    motion.tip.push_back(tip.displacement);
    motion.tip_velocity.push_back(tip.velocity);
    for (const double x : grid.places) {
      const BarPoint here = point(bar.from_tip(x), t);
      motion.displacement.push_back(here.displacement);
      motion.strain.push_back(bar.strain(here.strain));
      motion.velocity.push_back(here.velocity);
    }
  }
}

}  // namespace ricochet::reference

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
