#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <ricochet/contract/reference.hpp>

#include "modal_phase.hpp"

/// \file
/// A function of x ∈ [0, L] on equal panels. Each has eight Gauss points and the Legendre polynomial of degree 7
/// through them. That knows the second derivative, which a bending energy needs.
namespace ricochet::event_driven {

class PanelSeries {
 public:
  static constexpr int points = 8;

  PanelSeries(const std::function<double(double)>& f, double length, int panels)
      : width_(length / panels), panels_(panels), series_(points, panels) {
    for (int i = 0; i < panels; ++i) {
      series_.col(i).setZero();
      for (int g = 0; g < points; ++g) {
        const double value = f((i + 0.5 * (1 + abscissa(g))) * width_);
        largest_ = std::max(largest_, std::abs(value));
        finite_ = finite_ && std::isfinite(value);
        series_.col(i) += 0.5 * weight(g) * value * (legendre(abscissa(g)).col(0) * odd_numbers()).matrix();
      }
    }
  }

  bool finite() const { return finite_; }
  double largest() const { return largest_; }  ///< max |f| at the Gauss points
  double value(double x) const { return derivative(x, 0); }
  double slope(double x) const { return derivative(x, 1) * 2 / width_; }
  double curvature(double x) const { return derivative(x, 2) * 4 / (width_ * width_); }

  /// ∫₀ᴸ g(x) dx by the Gauss points of `panels` equal panels; g a number or an array like `zero`.
  template <class Function, class Value = double>
  static Value integral(const Function& g, double length, int panels, const Value& zero = Value{}) {
    Value sum = zero;
    for (int i = 0; i < panels; ++i)
      for (int j = 0; j < points; ++j) sum += weight(j) * g((i + 0.5 * (1 + abscissa(j))) * length / panels);
    return sum * (length / (2 * panels));
  }

 private:
  using Column = Eigen::Array<double, points, 1>;

  static double signed_of(const std::array<double, 4>& half, int g, double sign) {
    return g < 4 ? sign * half[static_cast<std::size_t>(3 - g)] : half[static_cast<std::size_t>(g - 4)];
  }
  static double abscissa(int g) {
    return signed_of({0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363}, g, -1);
  }
  static double weight(int g) {
    return signed_of({0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763}, g, 1);
  }
  static Column odd_numbers() { return Column::LinSpaced(1, 2 * points - 1); }

  // P_j, P_j', P_j'' (columns) for j < points (rows).
  static Eigen::Array<double, points, 3> legendre(double x) {
    Eigen::Array<double, points, 3> p = Eigen::Array<double, points, 3>::Zero();
    p(0, 0) = 1;
    p(1, 0) = x;
    p(1, 1) = 1;
    for (int j = 1; j + 1 < points; ++j) {
      p(j + 1, 0) = ((2 * j + 1) * x * p(j, 0) - j * p(j - 1, 0)) / (j + 1);
      p(j + 1, 1) = p(j - 1, 1) + (2 * j + 1) * p(j, 0);
      p(j + 1, 2) = p(j - 1, 2) + (2 * j + 1) * p(j, 1);
    }
    return p;
  }

  double derivative(double x, int order) const {
    const int i = std::clamp(static_cast<int>(x / width_), 0, panels_ - 1);
    return (series_.col(i).array() * legendre(2 * (x / width_ - i) - 1).col(order)).sum();
  }

  double width_;
  int panels_;
  Eigen::Matrix<double, points, Eigen::Dynamic> series_;
  double largest_ = 0;
  bool finite_ = true;
};

}  // namespace ricochet::event_driven

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

/// \file
/// The viscoelastic beam on its moving support, in the modes of flight and in those of contact at the tip.
namespace ricochet::event_driven {

/// The support φ = A sin θ, θ = ωt + ψ, and what the marching unknown w = u − φ feels of it.
struct Support {
  double amplitude, pulsation, phase;
  double at(double t) const { return amplitude * std::sin(pulsation * t + phase); }
  double rate(double t) const { return amplitude * pulsation * std::cos(pulsation * t + phase); }
  double integral(double t) const {
    return pulsation > 0 ? -amplitude / pulsation * std::cos(pulsation * t + phase) : at(0) * t;
  }
};

/// The continuous beam per unit of ρS, in the two bases, and the L² products that lead from one to the other. With the
/// lift p = (3x²L − x³)/(2L³) of contact:
///
///     ⟨φ_m,ψ_n⟩ = φ_m(L)ψ_n'''(L)/(μ_n⁴ − λ_m⁴),  ⟨p,φ_m⟩ = 3φ_m(L)/(L³λ_m⁴),  ⟨p,ψ_n⟩ = ψ_n'''(L)/μ_n⁴
struct Beam {
  Beam(const ReferenceProblem& problem, int modes)
      : length(problem.length),
        k2(problem.stiffness / problem.inertia),
        density(problem.inertia),
        alpha(problem.damping_stiffness),
        eta(problem.damping_mass),
        support{problem.support_amplitude, problem.support_pulsation, problem.support_phase},
        free(BeamModes::End::free, modes, length),
        pinned(BeamModes::End::pinned, modes, length) {
    const Eigen::ArrayXd free4 = free.wave_number.square().square(), pinned4 = pinned.wave_number.square().square();
    change.resize(modes, modes);
    for (int n = 0; n < modes; ++n)
      change.col(n) = (free.end_value * pinned.end_shear(n) / (pinned4(n) - free4)).matrix();
    lift_free = 3 * free.end_value / (std::pow(length, 3) * free4);
    lift_pinned = pinned.end_shear / pinned4;
    load_free = load_pinned = Eigen::ArrayXd::Zero(modes);
    if (problem.load_zero) return;
    const auto load = [&](double x) { return problem.load(x, 0) / density; };
    load_free = projection(load, free, length);
    load_pinned = projection(load, pinned, length);
    load_lift = PanelSeries::integral([&](double x) { return load(x) * lift(x); }, length, modes);
  }

  double lift(double x) const { return x * x * (3 * length - x) / (2 * std::pow(length, 3)); }
  double lift_curvature(double x) const { return 3 * (length - x) / std::pow(length, 3); }
  double lift_mean() const { return 3 * length / 8; }
  double lift_square() const { return 33 * length / 140; }
  Eigen::ArrayXd stiffness(const BeamModes& modes) const { return k2 * modes.wave_number.square().square(); }
  /// ⟨f, φ_m⟩ of all modes, by eight Gauss points per half wave of the highest.
  template <class Function>
  static Eigen::ArrayXd projection(const Function& f, const BeamModes& modes, double length) {
    Eigen::ArrayXd shapes(modes.count());
    return PanelSeries::integral(
        [&](double x) {
          for (int m = 0; m < modes.count(); ++m) shapes(m) = modes.value(m, x);
          return Eigen::ArrayXd(f(x) * shapes);
        },
        length, modes.count(), Eigen::ArrayXd(Eigen::ArrayXd::Zero(modes.count())));
  }

  double length, k2, density, alpha, eta;
  Support support;
  BeamModes free, pinned;
  Eigen::MatrixXd change;  ///< ⟨φ_m, ψ_n⟩
  Eigen::ArrayXd lift_free, lift_pinned, load_free, load_pinned;
  double load_lift = 0;  ///< ⟨f/ρS, p⟩
};

inline Oscillators oscillators(const Beam& beam, const BeamModes& modes) {
  const Eigen::ArrayXd stiffness = beam.stiffness(modes);
  return {stiffness, beam.alpha * stiffness + beam.eta};
}

inline Eigen::ArrayXcd steady(const Oscillators& modes, const Eigen::ArrayXcd& forcing, double pulsation) {
  Eigen::ArrayXcd result(modes.size());
  for (Eigen::Index m = 0; m < modes.size(); ++m)
    result(m) = forcing(m) / Complex(modes.stiffness(m) - pulsation * pulsation, modes.damping(m) * pulsation);
  return result;
}

/// Free flight: a'' + (αω₀² + η)a' + ω₀²a = ⟨f/ρS − φ'', φ_m⟩, watched at the tip (absolute).
inline ModalPhase flight_of(const Beam& beam) {
  const Support& s = beam.support;
  const Oscillators modes = oscillators(beam, beam.free);
  const Eigen::ArrayXd still = beam.load_free / modes.stiffness();
  const Eigen::ArrayXcd swing =
      steady(modes, (s.amplitude * s.pulsation * s.pulsation * beam.free.mean).cast<Complex>(), s.pulsation);
  ModalPhase::Watched tip{beam.free.end_value, Eigen::ArrayXd::Zero(modes.size()), (beam.free.end_value * still).sum(),
                          (beam.free.end_value * swing).sum() + s.amplitude};
  return {modes, still, swing, tip, s.pulsation, s.phase};
}

/// Contact, w = r p + Σ c_n ψ_n with r = s − φ: c'' + (αω₀² + η)c' + ω₀²c = ⟨f/ρS − φ''(1 − p) + ηφ'p, ψ_n⟩, watched by
/// the force of the stop over EI, 3(r + αr')/L³ − Σψ_n'''(L)(c_n + αc_n'). Modes left out follow their load at once:
/// Σ over all n of ψ_n'''⟨g,ψ_n⟩/μ_n⁴ is ⟨g,p⟩, which closes the sum.
inline ModalPhase contact_of(const Beam& beam) {
  const Support& s = beam.support;
  const Oscillators modes = oscillators(beam, beam.pinned);
  const double inertia = s.amplitude * s.pulsation * s.pulsation, drag = beam.eta * s.amplitude * s.pulsation;
  const Eigen::ArrayXd rest = beam.pinned.mean - beam.lift_pinned;
  const Eigen::ArrayXd still = beam.load_pinned / modes.stiffness();
  const Eigen::ArrayXcd swing =
      steady(modes, inertia * rest.cast<Complex>() + Complex(0, drag) * beam.lift_pinned, s.pulsation);
  const Complex damped(1, beam.alpha * s.pulsation);
  ModalPhase::Watched force{-beam.pinned.end_shear, -beam.alpha * beam.pinned.end_shear};
  force.constant = (force.position * still).sum();
  force.harmonic = -3 * s.amplitude / std::pow(beam.length, 3) * damped + (force.position * swing).sum() * damped;
  force.constant -= (beam.load_lift - (beam.lift_pinned * beam.load_pinned).sum()) / beam.k2;
  const double highest = std::sqrt(modes.stiffness()(modes.size() - 1));
  if (s.pulsation < 0.3 * highest)
    force.harmonic -= (inertia * (beam.lift_mean() - beam.lift_square() - (beam.lift_pinned * rest).sum()) +
                       Complex(0, drag) * (beam.lift_square() - beam.lift_pinned.square().sum())) /
                      beam.k2;
  return {modes, still, swing, force, s.pulsation, s.phase};
}

}  // namespace ricochet::event_driven
