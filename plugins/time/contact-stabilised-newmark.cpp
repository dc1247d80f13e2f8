#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Deuflhard, Krause and Ertel's contact-stabilised Newmark (¼, ½). First the predictor is brought between the stops in
/// the metric of the mass, then the step is made from there, with z = v_{n+1} − v_n:
///
///     stage 1:   M d/h² = Hᵀν,                    y = H(q + h v + d)
///     stage 2:   (M/h + ½C + h/4 K) z = ½F(t) + ½F(t+h) − C v − K(q + h/2 v + ½d) + Hᵀp
///                q ← q + h v + d + h/2 z,   v ← v + z,   y = H q_{n+1}
///
/// original: d moves positions alone. corrected: v gains d/h as well. Energy (undamped, free): ½|v|²_M + ½|q|²_K; at a
/// fixed stop a step of the original changes it by pᵀ(Hq_{n+1} − Hq_n) − νᵀH(v_{n+1} − v_n) h, both ≤ 0. The second
/// product is of two stages: no plan says it, and the balance is left open.
PlanOrRefusal contact_stabilised_newmark(const Parameters& p, double h, const ProblemFacts& facts) {
  if (facts.mass_kernel_dimension > 0)
    return Refusal{
        "the projection of the predictor is made in the metric of the mass, which is singular here: use a regular "
        "mass, or midpoint"};
  const double pushed = p.word("velocity") == "corrected" ? 1 / h : 0;
  const auto [q, v, d] = slots<3>();
  Stage step = mean_step(h, middle(), q + h * v + d + h / 2 * z, v + pushed * d + z);
  step.load = both_ends();
  step.work.reset();
  step.update.push_back({});
  StepPlan plan = mean_step_plan();
  plan.slots.emplace_back("d");
  plan.initial.push_back({0, 0});
  plan.stages = {projection(h, q + h * v, {q, v, z}), step};
  plan.facts.needs_regular_mass = true;
  plan.facts.contact_never_gains = !facts.damped;  // the projection moves positions past the dashpots
  return plan;
}

void register_contact_stabilised_newmark(Registry& registry) {
  registry.add_time(
      {.name = "contact-stabilised-newmark",
       .summary = "Newmark (¼, ½) from a predictor that is first brought between the stops",
       .text = R"(The predictor q + h v is brought between the stops before the step is made: forces at contact are
          clean and contact never gives energy. The original leaves velocities alone, so that a node that rests on a
          stop keeps the velocity of its arrival for as long as it stays: a single mass never leaves its stop, and
          on a mesh the motion as the step shrinks is not that of the mesh but O(element length) away. `corrected`
          takes the projection into the velocity and has no such defect.)",
       .source = R"(Deuflhard, Krause and Ertel (2008), A contact-stabilized Newmark method for dynamical contact
          problems; corrected: this program)",
       .parameters = {word_parameter("velocity", {"original", "corrected"}, "original",
                                     "whether the projection moves positions alone, or velocities with them")},
       .words = "contact-stabilised Newmark"},
      contact_stabilised_newmark);
}

}  // namespace

RICOCHET_PLUGIN(time, contact_stabilised_newmark, register_contact_stabilised_newmark)
