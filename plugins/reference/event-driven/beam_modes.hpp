#pragma once
#include <Eigen/Core>
#include <cmath>
#include <numbers>

/// \file
/// Bending modes of a uniform beam clamped at x = 0: φ'''' = λ⁴φ, ∫₀ᴸφ² dx = 1,
///
///     φ(x)√L = cosh λx − cos λx − σ(sinh λx − sin λx)
///
/// written with exponentials that decay only, so that the three hundredth mode is as exact as the first. Wave numbers:
/// cos z cosh z = −1 where x = L is free, tan z = tanh z where it is pinned, z = λL (Young and Felgar 1949).
namespace ricochet::event_driven {

class BeamModes {
 public:
  enum class End { free, pinned };  ///< at x = L: φ'' = φ''' = 0, or φ = φ'' = 0

  BeamModes(End end, int count, double length)
      : wave_number(count), mean(count), end_value(count), end_shear(count), length_(length), rising_(count) {
    const double norm = 1 / std::sqrt(length);
    for (int m = 0; m < count; ++m) {
      const double z = end == End::free ? free_root(m) : pinned_root(m);
      const double decay = std::exp(-z), lambda = z / length, cubed = lambda * lambda * lambda;
      rising_(m) = end == End::free
                       ? (std::sin(z) - std::cos(z) - decay) / (1 - decay * decay + 2 * decay * std::sin(z))
                       : -decay / (1 - decay * decay);
      wave_number(m) = lambda;
      end_value(m) = end == End::free ? norm * (m % 2 == 0 ? 2 : -2) : 0;
      end_shear(m) = end == End::free ? 0 : -norm * cubed * (1 / std::sinh(z) + 1 / std::sin(z));
      const double sigma = 1 - 2 * rising_(m) * decay;
      mean(m) = (end_shear(m) + 2 * sigma * norm * cubed) / (cubed * lambda);
    }
  }

  int count() const { return static_cast<int>(wave_number.size()); }
  double value(int m, double x) const { return shape(m, x, -1); }
  double curvature(int m, double x) const { return wave_number(m) * wave_number(m) * shape(m, x, 1); }

  Eigen::ArrayXd wave_number;  ///< λ, 1/m
  Eigen::ArrayXd mean;         ///< ∫φ dx
  Eigen::ArrayXd end_value;    ///< φ(L)
  Eigen::ArrayXd end_shear;    ///< φ'''(L)

 private:
  // φ for sign −1, φ''/λ² for sign +1.
  double shape(int m, double x, double sign) const {
    const double z = wave_number(m) * length_, a = wave_number(m) * x, small = rising_(m) * std::exp(-z);
    return (rising_(m) * std::exp(a - z) + (1 - small) * std::exp(-a) +
            sign * (std::cos(a) - (1 - 2 * small) * std::sin(a))) /
           std::sqrt(length_);
  }

  // Newton from the asymptotic root; it is within 0.31 of the first and 0.02 of all others.
  static double free_root(int m) {
    double z = (m + 0.5) * std::numbers::pi;
    for (int i = 0; i < 8; ++i) {
      const double sech = 1 / std::cosh(z);
      z += (std::cos(z) + sech) / (std::sin(z) + sech * std::tanh(z));
    }
    return z;
  }
  static double pinned_root(int m) {
    double z = (m + 1.25) * std::numbers::pi;
    for (int i = 0; i < 8; ++i) {
      const double t = std::tanh(z);
      z -= (std::sin(z) - t * std::cos(z)) / (t * (std::sin(z) + t * std::cos(z)));
    }
    return z;
  }

  double length_;
  Eigen::ArrayXd rising_;  // (1 − σ)e^z/2
};

}  // namespace ricochet::event_driven
