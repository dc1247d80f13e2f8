#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Laursen and Chawla's conserving contact on the mid-point rule. With z = v_{n+1} − v_n:
///
///     (M/h + ½C + h/4 K) z = F(t+h/2) − C v − K(q + h/2 v) + Hᵀp
///     q ← q + h v + h/2 z,   v ← v + z
///
/// Persistency condition, on the points that have reached a stop at t_n: 0 ≤ p ⊥ v_n + v_{n+1} ≥ 0 against the stop.
/// That is p (g_{n+1} − g_n) = 0, Newton's law with e = 1. Invariant: ½|v|²_M + ½|q|²_K, kept through contact as well;
/// test displacement q_{n+1} − q_n.
PlanOrRefusal laursen_chawla(const Parameters&, double h, const ProblemFacts& facts) {
  if (facts.contact && facts.mass_kernel_dimension > 0)
    return Refusal{
        "a contact point without mass (singular mass) has no velocity that persistency could act on: the mid-point "
        "rule leaves the root −1 there. Use a regular mass, or midpoint"};
  const auto [q, v] = slots<2>();
  Stage step = mean_step(h, middle());
  step.impact = {v + z, at(1), VelocityGate{q, at(0), v, at(0), 1}};
  StepPlan plan = mean_step_plan();
  plan.stages = {step};
  plan.facts.needs_regular_mass = true;
  plan.facts.contact_never_gains = true;
  return plan;
}

void register_laursen_chawla(Registry& registry) {
  registry.add_time(
      {.name = "laursen-chawla",
       .summary = "mid-point rule with contact that conserves energy: no work over a step",
       .text = R"(The mid-point rule; a point that has passed its stop may be pushed only where it does not move
          against the stop over the step, p (g_{n+1} − g_n) = 0. So rigid contact does no work and the energy of an
          undamped structure is kept to round-off; the penetration with which a contact begins stays until it is
          over. It is Newton's law with e = 1 asked at the beginning of the step.)",
       .source = R"(Laursen and Chawla (1997), Design of energy conserving algorithms for frictionless dynamic contact
          problems)",
       .parameters = {},
       .words = "Laursen–Chawla"},
      laursen_chawla);
}

}  // namespace

RICOCHET_PLUGIN(time, laursen_chawla, register_laursen_chawla)
