#include <cmath>

#include "alpha_mean_force.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Kane, Repetto, Ortiz and Marsden's Newmark, contact implicit whatever β and γ. Velocities jump by w, positions by
/// (h/2)w. Effort p is the mean force of the step, z = a_{n+1} the acceleration of the structure alone. With k = (1−γ)h
/// and c = (½−β)h²,
///
///     (M + γhC + βh²K) z = F(t+h) − C(v + k a) − K(q + h v + c a) − (C + (h/2)K) w,     R w = Hᵀp
///     q ← q + h v + c a + βh² z + (h/2)w,   v ← v + k a + γh z + w,   a ← z,   y = H q_{n+1}
///
/// Energy (free): E = ½|v|²_M + ½|q|²_K + ½εh²|a|²_M, ε = β − γ/2. A step takes (γ−½)(|Δq|²_K + εh²|Δa|²_M). With
/// `energy`, R = (M + εh²K)/h, contact gives p(bound − H q_n) ≤ 0, since M Δa + K Δq = ΔF − C Δv. Besides it gives
/// εh w·(CΔv − ΔF), for which no work form is declared. R = M/h (`mass`) gives −εh²Δa·Hᵀp more, of either sign. At
/// β = γ/2 both are the same, the balance is whole and no second unknown is needed (newmark_mean_step). At (¼, ½) no
/// acceleration is: z = v_{n+1} − v_n, (M/h + ½C + h/4 K) z = ½F(t) + ½F(t+h) − C v − K(q + h/2 v) + Hᵀp.
PlanOrRefusal kane(const Parameters& p, double h, const ProblemFacts& facts) {
  const AlphaMethod newmark = AlphaMethod::newmark(p.real("beta"), p.real("gamma"));
  const double epsilon = newmark.beta - newmark.gamma / 2;
  const bool jumps = epsilon != 0, damps = newmark.gamma != 0.5, energy = p.word("impulse") == "energy";
  if ((jumps || damps) && facts.mass_kernel_dimension > 0)
    return needs_mass("the acceleration at the end of the step", "use beta = 0.25 with gamma = 0.5, or a regular mass");
  StepPlan plan = mean_step_plan();
  plan.facts = {.order = damps ? 1.0 : 2.0, .needs_regular_mass = jumps || damps, .contact_never_gains = true};
  plan.stages = {mean_step(h, both_ends())};
  if (!jumps && !damps) return plan;
  plan.slots.emplace_back("a");
  plan.initial.push_back({0, 0});
  plan.start = {structure_acceleration<3>(0)};
  plan.stages = {newmark_mean_step(newmark, h), structure_acceleration<3>(1)};
  if (!jumps) return plan;
  // With β < γ/2 what γ > ½ takes is no sum of squares.
  const bool balanced = !damps || epsilon >= 0;
  plan.stages = {newmark_jumping_step(newmark, h, M / h + (energy ? epsilon * h : 0.0) * K, balanced)};
  plan.energy.push_back(square(EnergyMatrix::M, 0.5 * epsilon * h * h, slots<3>()[2]));
  plan.facts.contact_never_gains = energy && balanced && !facts.damped;
  if (epsilon < 0) plan.facts.stability_limit = 1 / std::sqrt(-epsilon);
  return plan;
}

void register_kane(Registry& registry) {
  registry.add_time(
      {.name = "kane",
       .summary = "Newmark whose contact is implicit in position and left out of the acceleration",
       .text = R"(Newmark's updates; the contact force is a mean over the step that keeps q_{n+1} between the stops,
          and the acceleration that the next step starts from is that of the structure alone. A massed point keeps
          between none and all of its speed, one half on average. Contact never gives energy for β = γ/2, nor,
          undamped and with impulse energy, for γ = ½ or β > γ/2. With (¼, ½) it is the mid-point rule with loads of
          both ends; γ = ½ is of second order whatever β, above it damps, at first order; β < γ/2 limits the step.)",
       .source = R"(Kane, Repetto, Ortiz and Marsden (1999), Finite element analysis of nonsmooth contact; Kane,
          Marsden, Ortiz and West (2000), Variational integrators and the Newmark algorithm)",
       .parameters = {real_parameter("beta", "1", 0.25, {.low = 0, .high = 0.5}, "β"),
                      real_parameter("gamma", "1", 0.5, {.low = 0.5, .high = 1}, "γ; above ½ it damps, at first order"),
                      word_parameter("impulse", {"energy", "mass"}, "energy",
                                     R"(where β ≠ γ/2, R of the jump R w = Hᵀp: energy, (M + (β−γ/2)h²K)/h, so that
          contact never gives energy; mass, M/h)")},
       .words = "Kane"},
      kane);
}

}  // namespace

RICOCHET_PLUGIN(time, kane, register_kane)
