#include <cmath>

#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Bathe's scheme of two sub-steps, a trapezium to t + γh, then a quadrature over three accelerations. With d = γh,
/// q₁ = (ρ+1)/(2γ(ρ−1)+4), q₂ = ½ − γq₁, q₀ = 1 − q₁ − q₂:
///
///     stage 1, z = a_γ:   (M + d/2 C + d²/4 K) z = F(t+d) − C(v + d/2 a) − K(q + d v + d²/4 a) + Hᵀp
///                         q ← q + d v + d²/4(a + z),   v ← v + d/2(a + z),   b ← a,   a ← z
///     stage 2, z = a₁:    (M + e C + e² K) z = F(t+h) − C v° − K q° + Hᵀp,   e = q₂h
///                         v₁ = v_n + h(q₀a_n + q₁a_γ + q₂z) = v° + e z,   q₁ = q_n + h(q₀v_n + q₁v_γ + q₂v₁) = q° +
///                         e²z
///
/// Each sub-step keeps its own end between the stops, y = H q. An effort of stage 1 gives the momentum hq₁, one of
/// stage 2 gives h(q₂ + q₀). No energy in M and K alone is known.
PlanOrRefusal bathe(const Parameters& p, double h, const ProblemFacts& facts) {
  const double rho = p.real("rho_inf"), given = p.real("split");
  const double split = given != 0 ? given : rho == 1 ? 0.5 : (2 - std::sqrt(2 + 2 * rho)) / (1 - rho);
  const double q1 = (rho + 1) / (2 * split * (rho - 1) + 4), q2 = 0.5 - split * q1, q0 = 1 - q1 - q2;
  const double d = split * h, e = q2 * h, later = q1 * h - d / 2, earlier = q0 * h - d / 2;
  const double shared = d * d / 4 - 0.5 * q0 * h * d;
  const auto [q, v, a, b] = slots<4>();
  const Stage trapezium = motion_at(split, q + d * v + d * d / 4 * (a + z), v + d / 2 * (a + z));
  // Before it q, v, a are those of t + γh, b the acceleration of t.
  const Stage quadrature =
      motion_at(1, q + (h - d) * v + (shared + e * later) * a + (shared + e * earlier) * b + e * e * z,
                v + later * a + earlier * b + e * z);
  StepPlan plan = plan_with({"q", "v", "a", "b"});
  plan.start = {initial_acceleration(d, split, facts.mass_kernel_dimension > 0 ? d * d / 4 : 0)};
  plan.stages = {trapezium, quadrature};
  plan.stages[0].impact = {.value = trapezium.update[0], .bound = at(split)};
  plan.stages[1].impact = {.value = quadrature.update[0], .bound = at(1)};
  plan.start[0].update.push_back(b);
  plan.stages[0].update.push_back(a);
  plan.stages[1].update.push_back(b);
  plan.facts.order = 2;
  return plan;
}

void register_bathe(Registry& registry) {
  registry.add_time(
      {.name = "bathe",
       .summary = "ρ∞-Bathe: two sub-steps, second order, as much damping of high frequencies as asked",
       .text = R"(A trapezoidal sub-step, then one over three points: with ρ∞ = 0 frequencies far above 1/h are gone
          in one step, low ones hardly feel it. Two solves per step. Stops are at position level at the end of each
          sub-step; a massed point is thrown back up to 2 (ρ∞ = 0) to 2.9 (ρ∞ = 0.8) times as fast as it came, so
          that energy may grow at impacts. On a singular mass it is of second order through contact, with a clean
          force. Implicit and averaged penalties coincide.)",
       .source = R"(Bathe and Baig (2005), On a composite implicit time integration procedure for nonlinear dynamics;
          Noh and Bathe (2019), The Bathe time integration method with controllable spectral radius)",
       .parameters = {real_parameter("rho_inf", "1", 0.0, {.low = 0, .high = 1},
                                     R"(ρ∞, what a step leaves of the highest frequencies; 1: two trapezia when split
          is ½)"),
                      real_parameter("split", "1", 0.0, {.low = 0, .high = 1, .high_open = true},
                                     R"(γ, where the first sub-step ends, in steps; 0: (2 − √(2+2ρ∞))/(1 − ρ∞), ½ at
          ρ∞ = 1, one matrix for both solves; 0.5 with ρ∞ = 0: the scheme of 2005)")},
       .words = "Bathe"},
      bathe);
}

}  // namespace

RICOCHET_PLUGIN(time, bathe, register_bathe)
