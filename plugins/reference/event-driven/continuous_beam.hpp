#pragma once
#include <ricochet/contract/reference.hpp>

#include "beam_modes.hpp"
#include "modal_phase.hpp"
#include "panel_series.hpp"

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
