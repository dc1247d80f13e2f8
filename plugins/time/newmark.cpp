#include <cmath>
#include <ricochet/contract/said_format.hpp>

#include "alpha_method.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Newmark's scheme in acceleration form, z = a_{n+1}:
///
///     (M + γhC + βh²K) z = F(t+h) − C(v + (1−γ)h a) − K(q + h v + (½−β)h² a) + Hᵀp
///     q ← q + h v + (½−β)h² a + βh² z,   v ← v + (1−γ)h a + γh z,   a ← z,   y = H q_{n+1}
///
/// Energy (undamped, free): E = ½|v|²_M + ½|q|²_K + ½(β−γ/2)h²|a|²_M. A step takes (γ−½)(|Δq|²_K + (β−γ/2)h²|Δa|²_M) of
/// it. Test displacement q_{n+1} − q_n with the equations of both ends, weighted by γ and 1−γ.
PlanOrRefusal newmark(const Parameters& p, double h, const ProblemFacts& facts) {
  const double beta = p.real("beta"), gamma = p.real("gamma"), shift = beta - gamma / 2;
  const bool unconditional = 2 * beta >= gamma, damps = gamma != 0.5;
  if (facts.mass_kernel_dimension > 0 && !unconditional)
    return Refusal{
        said("beta = {:g} < gamma/2 = {:g} makes the kernel of a singular mass diverge at any step: "
             "use beta ≥ gamma/2",
             beta, gamma / 2)};
  const auto [q, v, a] = slots<3>();
  const AlphaMethod method = AlphaMethod::newmark(beta, gamma);
  StepPlan plan = method.plan(h, facts);
  Stage& step = plan.stages[0];
  plan.energy.push_back(square(EnergyMatrix::M, 0.5 * shift * h * h, a));
  // Explicit: no effort moves q_{n+1}, which then is no measure of impact.
  if (beta == 0) step.impact.reset();
  // With β < γ/2 what γ > ½ takes is no sum of squares: the balance is not known, the energy falls all the same.
  if (!damps || unconditional) method.balance_both_ends(step, h, gamma, 1 - gamma);
  if (damps && unconditional)
    step.loss = {{EnergyMatrix::K, gamma - 0.5, method.increment(h)},
                 {EnergyMatrix::M, (gamma - 0.5) * shift * h * h, z - a}};
  if (damps) plan.facts.order = 1;
  plan.facts.needs_regular_mass = !unconditional;
  if (!unconditional) plan.facts.stability_limit = 1 / std::sqrt(-shift);
  return plan;
}

void register_newmark(Registry& registry) {
  registry.add_time(
      {.name = "newmark",
       .summary = "Newmark (β, γ) with the multiplier inside the acceleration, stops at position level",
       .text = R"(The method of structural dynamics: equilibrium and non-penetration at the end of the step, q_{n+1}
          between the stops. The effort acts through the acceleration, hence on three levels with weights (β,
          ½+γ−2β, ½−γ+β): a rigid impact leaves oscillating accelerations, and with β = ¼, γ = ½ the energy grows,
          the more the finer the step. It knows no restitution coefficient. Implicit and averaged penalties
          coincide.)",
       .source = R"(Newmark (1959); Hughes (1987), The Finite Element Method, section 9.1; energy growth at contact:
          Laursen and Chawla (1997))",
       .parameters = {real_parameter("beta", "1", 0.25, {.low = 0, .high = 0.5}, "β"),
                      real_parameter("gamma", "1", 0.5, {.low = 0.5, .high = 1},
                                     "γ; above ½ it damps, at first order")},
       .words = "Newmark"},
      newmark);
}

}  // namespace

RICOCHET_PLUGIN(time, newmark, register_newmark)
