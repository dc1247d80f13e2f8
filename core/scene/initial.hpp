#pragma once
#include <ricochet/scene/semi_discrete.hpp>

namespace ricochet {

/// Interpolation of w = u0 − φ(0) and w_t = u1 − φ'(0): values and slopes at the free nodes into `position` and
/// `velocity`. What the clamp imposes is dropped, and a note says so when the formulas differ from it.
void interpolate_initial(const SceneSpec& scene, SemiDiscrete& problem);

/// Fills problem.kernel_energy from the state as it is. `pushed`: Gᵀp of a compliant law that pushes in it, n; empty:
/// none does.
void measure_mass_constraint(SemiDiscrete& problem, const Eigen::VectorXd& pushed = {});

/// Brings the state onto the constraint of a singular mass. Z spans Ker M; multiplied by Zᵀ the equation of motion has
/// no inertia left (C = αK + ηM, MZ = 0):
///
///     Zᵀ(α K v + K q − F(t)) = 0,     F = load − φ'' s                                              (1)
///
/// α = 0: (1) constrains q, its time derivative v:   ZᵀK q = ZᵀF(0),  ZᵀK v = ZᵀF'(0).
/// α > 0: (1) gives the v that goes with any q; q is put at rest on it:  ZᵀK q = ZᵀF(0), then  ZᵀK v = 0.
///
/// Both by x ← x − Z(ZᵀKZ)⁻¹Zᵀ(Kx − right side), the nearest such state in the norm of K; M x is not changed. F'(0) by
/// seven forward values of the load, 2e-5 s apart (sixth order). Adds the energy it cost, and a note.
void project_on_mass_constraint(SemiDiscrete& problem);

}  // namespace ricochet
