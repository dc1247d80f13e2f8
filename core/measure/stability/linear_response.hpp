#pragma once
#include <complex>
#include <optional>
#include <ricochet/engine/compile.hpp>
#include <vector>

namespace ricochet {

/// The periodic motion that a scheme gives without contact, for a support that moves as A sin(ωt + ψ): of every slot,
/// x_n = Re(X e^{iωt_n}), exactly (no integration), mode by mode of M φ = μ K φ. `amplitude` scales it: everything is
/// linear.
struct LinearResponse {
  std::vector<std::complex<double>> contact;  ///< of u = φ + w at the contact points, m per metre of A
  std::complex<double> tip;                   ///< of the tip, m per metre of A
};

/// Nothing where a load other than the support's acts, where ω = 0, in resonance of an undamped scheme, or where the
/// structure is held by nothing.
std::optional<LinearResponse> linear_response(const SemiDiscrete& problem, const StepPlan& plan, double h);

/// How far the periodic motion without contact goes beyond the nearer stop, over the steps of a period: < 0 where it
/// stays between the stops, 0 at grazing. m.
double overlap(const LinearResponse& response, const LaneSpec& lane);

}  // namespace ricochet
