#include "alpha_method.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Wood, Bossak and Zienkiewicz's scheme, the α-method that weights inertia alone: α_m = (ρ−1)/(ρ+1), γ = ½ − α_m,
/// β = ¼(1 − α_m)². At ρ = 1 it is Newmark (¼, ½).
PlanOrRefusal wbz_alpha(const Parameters& p, double h, const ProblemFacts& facts) {
  const double rho = p.real("rho_inf"), mass = (rho - 1) / (rho + 1);
  const AlphaMethod method{.mass = mass, .beta = 0.25 * (1 - mass) * (1 - mass), .gamma = 0.5 - mass};
  StepPlan plan = method.plan(h, facts);
  method.add_filtered_energy(plan, h);
  if (mass == 0) method.balance_both_ends(plan.stages[0], h, 0.5, 0.5);
  return plan;
}

void register_wbz_alpha(Registry& registry) {
  registry.add_time(
      {.name = "wbz-alpha",
       .summary = "Wood–Bossak–Zienkiewicz α: Newmark with inertia weighted over both ends of the step",
       .text = R"(Newmark's updates, the inertia force weighted 1−α_m and α_m with α_m = (ρ∞−1)/(ρ∞+1) ≤ 0,
          equilibrium of all other forces at the end of the step: of second order, unconditionally stable, the
          highest frequencies keep ρ∞ per step. Stops are at position level: a massed point is thrown back up to 2.6
          times as fast as it came (ρ∞ = 0.8), so that energy may grow at impacts. Implicit and averaged penalties
          coincide.)",
       .source = "Wood, Bossak and Zienkiewicz (1980), An alpha modification of Newmark's method",
       .parameters = {real_parameter("rho_inf", "1", 0.8, {.low = 0, .high = 1},
                                     "ρ∞, what a step leaves of the highest frequencies; 1 is Newmark (¼, ½)")},
       .words = "WBZ"},
      wbz_alpha);
}

}  // namespace

RICOCHET_PLUGIN(time, wbz_alpha, register_wbz_alpha)
