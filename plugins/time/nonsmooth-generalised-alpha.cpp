#include "alpha_mean_force.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// The coupled generalised-α scheme whose velocities jump: Chung and Hulbert's α-method carries the smooth motion,
/// w = h M⁻¹Hᵀp the contact. p is the mean force of a step. k = (1−γ)h, c = (½−β)h², f = 1−α_f, z = a_{n+1}; `half`:
///
///     v ← v + k a + γh z + w,   q ← q + h v + c a + βh² z + (h/2)w,   a ← z,   y = H v_{n+1}
///     (1−α_m) M z + f(C v_{n+1} + K q_{n+1}) = f F(t+h) + α_f(F(t) − C v − K q) − α_m M a
///
/// `beta` is coupled_plan. `projected` then puts positions between the stops before its last stage. A side is closed
/// where q + h v + ½h² a passes it. At ρ∞ = 1 the balance of ½|v|²_M + ½|q|²_K with Δq is whole; below none is known,
/// as a load moves the filter σ too.
PlanOrRefusal nonsmooth_generalised_alpha(const Parameters& p, double h, const ProblemFacts& facts) {
  if (facts.mass_kernel_dimension > 0) return needs_mass("a velocity jump", "use generalised-alpha, or a regular mass");
  const AlphaMethod method = AlphaMethod::chung_hulbert(p.real("rho_inf"));
  const bool half = p.word("position") == "half", projected = p.word("position") == "projected";
  const bool trapezium = method.gamma == 0.5 && !projected;
  const auto [q, v, x2, x3] = slots<4>();  // coupled_plan keeps b before a
  StepPlan plan = half ? method.plan(h, facts) : coupled_plan(method, h);
  plan.start[0].impact.reset();
  if (half) plan.stages = {method.jumping_step(h, M / h)};
  if (projected) plan.stages.insert(plan.stages.begin() + 1, projection(h, q, {q + z, v, x2, x3}));
  Stage& step = plan.stages[0];
  const Combination next = step.update[0], next_v = step.update[1], rate = halfway(v, next_v);
  const VelocityGate gate{q + h * v + 0.5 * h * h * (half ? x2 : x3), at(1), v, at(0), p.real("restitution")};
  step.impact = {next_v, at(1), gate, {half ? 0.0 : 1.0}};
  if (half) step.at(Evaluation::explicit_start) = method.asked_early(h, 0);
  if (trapezium) {
    conserve_mean_force(step, next, rate);
    balance_mean_force(step, next, rate);
    step.at(Evaluation::conserving)->effort = {half ? 0.0 : 1.0};
    step.work->impulse = half ? 1 : 0;
    if (!half) plan.stages.back().work = {{}, v, at(1)};  // moves nothing
  }
  method.add_filtered_energy(plan, h);
  plan.facts.restitution = Restitution::exact;
  plan.facts.needs_regular_mass = true;
  plan.facts.contact_never_gains = half || trapezium;
  return plan;
}

void register_nonsmooth_generalised_alpha(Registry& registry) {
  registry.add_time(
      {.name = "nonsmooth-generalised-alpha",
       .summary = "generalised α whose velocities jump by Newton's impact law",
       .text = R"(The smooth motion is that of generalised-alpha, of second order with ρ∞ at the highest
          frequencies; contact is an impulse of the step that jumps velocities, on which that damping does not act,
          and the restitution holds exactly for each point that the gap test q + h v + ½h² a finds closed and that
          does not leave. With `half` positions move by half of the jump, as the authors have it; with `beta` by β/γ
          of it, the same at ρ∞ = 1; `projected` adds a projection of positions, so that no step ends beyond a stop.
          Contact never gives energy with `half`, in the energy of the scheme: a jump leaves Δq = h(v_n + v_{n+1})/2 +
          ¼ε²h²Δa as in free motion, and its work is (h/2) p·H(v_n + v_{n+1}) ≤ 0. Nor with `beta` at ρ∞ = 1;
          elsewhere it may.)",
       .source = R"(Chen, Acary, Virlez and Brüls (2013), A nonsmooth generalized-α scheme for flexible multibody
          systems with unilateral constraints; projected: after Brüls, Acary and Cardona (2014))",
       .parameters = {real_parameter("rho_inf", "1", 0.8, {.low = 0, .high = 1},
                                     "ρ∞, what a step leaves of the highest frequencies; 1 does not damp"),
                      restitution_parameter(),
                      word_parameter("position", {"half", "beta", "projected"}, "half",
                                     R"(what a jump w moves positions by: half, (h/2)w; beta, (β/γ)h w; projected,
          that and onto the stops)")},
       .words = "nonsmooth generalised α"},
      nonsmooth_generalised_alpha);
}

}  // namespace

RICOCHET_PLUGIN(time, nonsmooth_generalised_alpha, register_nonsmooth_generalised_alpha)
