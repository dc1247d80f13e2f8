#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Laursen and Love's velocity update on the mid-point rule: conserving, and no penetration at the end of a step.
///
///     stage 1, z = v* − v_n:       (M/h + ½C + h/4 K) z = F(t+h/2) − C v − K(q + h/2 v) + Hᵀλ
///                                  q ← q + h v + h/2 z,   v ← v + z,   y = H q_{n+1} between the stops
///     stage 2, z = v_{n+1} − v*:   M z/h = Hᵀp,   v ← v + z,
///                                  p_i h(H_i v* + ½ H_i z) = −λ_i (g_{n+1} − g_n)_i,   p_i on the side of λ_i
///
/// g_{n+1} − g_n is the motion of a point against its stop over the step. Where the stop moves, so does the velocity of
/// the second stage: by φ' at t+h, as φ(t+3h/2) − φ(t+h/2). With g_n between the stops λ_i (g_{n+1} − g_n)_i ≤ 0, and
/// there is one p. Invariant: ½|v|²_M + ½|q|²_K, kept through contact: both stages together do no work at any point.
/// Test displacements h(v + z/2) of both; one massed point leaves as fast as it came.
PlanOrRefusal laursen_love(const Parameters&, double h, const ProblemFacts& facts) {
  if (facts.contact && facts.mass_kernel_dimension > 0)
    return Refusal{
        "a contact point without mass (singular mass) has no velocity that could be changed alone: the mid-point rule "
        "leaves the root −1 there. Use a regular mass, or midpoint"};
  const auto [q, v] = slots<2>();
  const Combination way = h * v + h / 2 * z;
  const Levels moved = at(1.5) - at(0.5);
  Stage velocity_update = equation(M / h * z, {});
  velocity_update.work = {.displacement = way, .rate = {}, .load = {}, .support = moved};
  velocity_update.impact = {.value = way, .bound = moved, .restores = 1};
  velocity_update.update = {q, v + z};
  StepPlan plan = mean_step_plan();
  plan.stages = {mean_step(h, middle()), velocity_update};
  plan.facts.needs_regular_mass = true;
  plan.facts.contact_never_gains = true;
  return plan;
}

void register_laursen_love(Registry& registry) {
  registry.add_time(
      {.name = "laursen-love",
       .summary = "mid-point rule, stops at position level, then an impulse that gives contact's work back",
       .text = R"(The mid-point rule with the positions of its end between the stops; then the velocity alone is
          changed at the points that were pushed, until the stops have done no work over the step. So rigid contact
          conserves the energy of an undamped structure to round-off and nothing penetrates at the end of a step; a
          massed point leaves as fast as it came. Nothing is dissipated, hence contact forces chatter: read
          impulses. A step that begins beyond a stop (a law that lets points pass, a stop that was set anew) has no
          such impulse and ends the integration. Compliant laws are those of midpoint: nothing is then given back.)",
       .source = R"(Laursen and Love (2002), Improved implicit integrators for transient impact problems: geometric
          admissibility within the conserving framework)",
       .parameters = {},
       .words = "Laursen–Love"},
      laursen_love);
}

}  // namespace

RICOCHET_PLUGIN(time, laursen_love, register_laursen_love)
