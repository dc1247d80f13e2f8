#pragma once
#include <complex>
#include <functional>
#include <optional>
#include <ricochet/contract/contact_law.hpp>
#include <ricochet/engine/compile.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <vector>

namespace ricochet {

/// The periodic motion that a scheme gives without contact, for a support that moves as A sin(ωt + ψ): of every slot,
/// x_n = Re(X e^{iωt_n}), exactly (no integration), mode by mode of M φ = μ K φ. `amplitude` scales it: everything is
/// linear.
struct LinearResponse {
  std::vector<std::complex<double>> contact;  ///< of u = φ + w at the contact points, m per metre of A
  std::complex<double> tip;                   ///< of the tip, m per metre of A
};

/// Nothing where ω = 0, where a load other than the support's acts, or where damping has a matrix of its own. Nothing
/// either where S vanishes on a mode, in resonance of an undamped scheme, or where the structure is held by nothing.
std::optional<LinearResponse> linear_response(const SemiDiscrete& problem, const StepPlan& plan, double h);

/// How far the periodic motion without contact goes beyond the nearer stop, over all phases, m. It is < 0 where the
/// motion stays between the stops, 0 at grazing.
double overlap(const LinearResponse& response, const LaneSpec& lane);

/// A spring behind a stop and the mass that it turns back.
struct ContactSpring {
  double stiffness = 0, mass = 0;  ///< κ, N/m; m, kg
  double pulsation = 0;            ///< rad/s, of the mass on it and on the structure behind it
};

/// What a spring κ behind a point of contact turns back (the last point where none is said). It is the mode that has
/// most of its energy in that spring,
///
///     M φ = μ (K + κ hᵀh) φ,   φᵀ(K + κ hᵀh) φ = 1,   κ (h φ)² largest:   m = κ μ,   ω = 1/√μ,
///
/// a dense problem of n dofs, of 240 at most. Nothing beyond, where it has no points, no modes are found, or that one
/// has no mass.
std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness, int point = -1);
/// The same along a row h (n) of coordinates.
std::optional<ContactSpring> contact_spring(const SemiDiscrete& problem, double stiffness, const Eigen::VectorXd& h);

/// How much a contact law gives way, m/N. A rigid law has 0, one that declares a constant stiffness κ has 1/κ. Any
/// other has the secant d²/2U(d) of the energy U that it stores at the depth `depth` (m). Nothing for a compliant law
/// that says neither. It follows from the law alone, whatever its parameters are called. The law is prepared for one
/// point.
std::optional<double> contact_compliance(ContactLaw& law, const Parameters& parameters, double depth);

/// A value of a parameter at which the periodic motion without contact touches a stop for the first time.
struct Grazing {
  bool opens_below = false;  ///< whether the motion is without contact below the value
  double value = 0, low = 0, high = 0;
  int steps = 0;  ///< halvings made
};

/// Zeros of the overlap of a motion with its stops along a parameter. `overlap` is < 0 without contact, and has no
/// value where it is not known. It is evaluated at 17 to 32 of the ascending values, evenly spaced from the first, and
/// at the last. Fewer values are all evaluated. Where its sign changes from one to the next, the zero is bisected to
/// 1e-12 of its size, at most 60 times. Two zeros between two of these values are not seen.
std::vector<Grazing> find_grazings(const std::vector<double>& values,
                                   const std::function<std::optional<double>(double value)>& overlap);

}  // namespace ricochet
