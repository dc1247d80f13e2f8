#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

/// \file
/// Independent damped oscillators y'' + 2ζy' + ω₀²y = 0, one per mode, moved by their exact solution whatever ζ ≥ 0:
///
///     y(τ) = C y₀ + S v₀,   v(τ) = −ω₀²S y₀ + S' v₀,   C = S' + 2ζS,   S the response to a unit velocity
namespace ricochet::event_driven {

class Oscillators {
 public:
  /// C, S, S' of one time τ, per mode.
  struct Flow {
    Eigen::ArrayXd stay, kick, keep;
  };

  Oscillators() = default;
  /// ω₀² > 0 (1/s²) and 2ζ ≥ 0 (1/s), per mode.
  Oscillators(Eigen::ArrayXd stiffness, Eigen::ArrayXd damping)
      : stiffness_(std::move(stiffness)), damping_(std::move(damping)), split_(stiffness_.size()) {
    for (Eigen::Index m = 0; m < size(); ++m) {
      const double zeta = damping_(m) / 2, omega = std::sqrt(stiffness_(m));
      split_(m) = std::sqrt(std::abs(zeta - omega)) * std::sqrt(zeta + omega);
    }
  }

  Eigen::Index size() const { return stiffness_.size(); }
  double stiffness(Eigen::Index m) const { return stiffness_(m); }
  double damping(Eigen::Index m) const { return damping_(m); }
  const Eigen::ArrayXd& stiffness() const { return stiffness_; }
  const Eigen::ArrayXd& damping() const { return damping_; }

  /// C, S, S' at τ ≥ 0 of the first `count` modes. Roots −ζ ± split: complex below critical damping; above it the slow
  /// one is −ω₀²/(ζ + split), and differences of exponentials go through expm1.
  void flow(double tau, Eigen::Index count, Flow& out) const {
    for (Eigen::Index m = 0; m < count; ++m) {
      const double zeta = damping_(m) / 2, s = split_(m);
      if (stiffness_(m) > zeta * zeta && s > 0) {
        const double decay = std::exp(-zeta * tau), sine = std::sin(s * tau) / s, cosine = std::cos(s * tau);
        out.kick(m) = decay * sine;
        out.keep(m) = decay * (cosine - zeta * sine);
        out.stay(m) = decay * (cosine + zeta * sine);
      } else {
        const double slow = -stiffness_(m) / (zeta + s), decay = std::exp(slow * tau);
        out.kick(m) = s > 0 ? decay * -std::expm1(-2 * s * tau) / (2 * s) : decay * tau;
        out.keep(m) = slow * out.kick(m) + std::exp(-(zeta + s) * tau);
        out.stay(m) = decay - slow * out.kick(m);
      }
    }
  }
  Flow empty_flow() const {
    const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(size());
    return {zero, zero, zero};
  }

  /// Moves the first `count` modes by one flow.
  void advance(const Flow& flow, Eigen::Index count, Eigen::ArrayXd& y, Eigen::ArrayXd& v) const {
    for (Eigen::Index m = 0; m < count; ++m) {
      const double position = flow.stay(m) * y(m) + flow.kick(m) * v(m);
      v(m) = flow.keep(m) * v(m) - stiffness_(m) * flow.kick(m) * y(m);
      y(m) = position;
    }
  }

  /// What bounds a mode from now on: y is at most first·|e^{r₁τ}| + second·|e^{r₂τ}|, likewise its derivatives with
  /// powers of |r|. Within 5 % of critical damping both roots count as one of modulus ω₀, its derivatives of fourth
  /// order included.
  struct Envelope {
    Eigen::ArrayXd first, second;
  };
  /// Moduli of the two roots (first the slow one).
  Envelope moduli() const {
    Envelope roots{stiffness_.sqrt(), Eigen::ArrayXd::Zero(size())};
    for (Eigen::Index m = 0; m < size(); ++m)
      if (overdamped(m)) {
        roots.second(m) = damping_(m) / 2 + split_(m);
        roots.first(m) = stiffness_(m) / roots.second(m);
      }
    return roots;
  }
  bool overdamped(Eigen::Index m) const { return !nearly_critical(m) && damping_(m) * damping_(m) > 4 * stiffness_(m); }
  bool nearly_critical(Eigen::Index m) const { return split_(m) * split_(m) < 0.0025 * stiffness_(m); }

  void envelope(const Eigen::ArrayXd& y, const Eigen::ArrayXd& v, Eigen::Index count, Envelope& out) const {
    for (Eigen::Index m = 0; m < count; ++m) {
      const double zeta = damping_(m) / 2, s = split_(m), rate = v(m) + zeta * y(m);
      if (nearly_critical(m)) {
        out.first(m) = std::abs(y(m)) + 5 * std::abs(rate) / std::sqrt(stiffness_(m));
        out.second(m) = 0;
      } else if (damping_(m) * damping_(m) > 4 * stiffness_(m)) {
        const double fast = zeta + s, slow = stiffness_(m) / fast;
        out.first(m) = std::abs(v(m) + fast * y(m)) / (2 * s);
        out.second(m) = std::abs(v(m) + slow * y(m)) / (2 * s);
      } else {
        out.first(m) = std::sqrt(y(m) * y(m) + rate * rate / (s * s));
        out.second(m) = 0;
      }
    }
  }

 private:
  Eigen::ArrayXd stiffness_, damping_, split_;
};

}  // namespace ricochet::event_driven
