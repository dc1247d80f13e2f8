#pragma once
#include <optional>
#include <ricochet/contract/step_plan.hpp>
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

/// What a time scheme dissipates by itself, as the stiffness viscosity C = αK that would do the same.
struct EquivalentViscosity {
  double numerical = 0;  ///< α_eq, s; negative where the scheme makes free motion grow
  double physical = 0;   ///< the same fit to the decay of the structure's own damping, s; α where η = 0
  double misfit = 0;     ///< largest |2δ_k/ω_k² − α_eq| of the modes, s
  int modes = 0;         ///< modes fitted
};

/// α_eq of a plan with step h (s) on the free structure with C = 0. A mode of pulsation ω decays like e^{−δt} with
/// δ = αω²/2 under C = αK (and η/2 under C = ηM); the roots r_k of the step on the first `modes` modes with ω_k > 0
/// (those nearest to e^{iω_k h}) decay with
///
///     δ_k = −ln|r_k| / h,       α_eq = 2 Σ δ_k ω_k² / Σ ω_k⁴         (least squares of δ_k against αω_k²/2)
///
/// |r_k|² − 1 may be as small as 1e-16, so the step is composed in quadruple precision from the plan's own numbers. A
/// scheme that conserves then gives |α_eq| of about 1e-16 h. To the lowest order in h, the θ-scheme gives (2θ−1)h and
/// Newmark's (γ−½)h.
///
/// `undamped_plan`: the plan for facts without damping; its stages may weigh C, which is zero here. Nothing where no
/// mode moves (K = 0, M = 0), where S vanishes on a mode, or where the roots are not found. Nothing either where
/// damping has a matrix of its own, and above 1200 dofs, where modes cost more than marching.
std::optional<EquivalentViscosity> equivalent_viscosity(const SemiDiscrete& problem, const StepPlan& undamped_plan,
                                                        double h, int modes = 3);

}  // namespace ricochet
