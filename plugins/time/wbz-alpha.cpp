#include <ricochet/contract/plugin.hpp>

#include "alpha_method.hpp"

namespace {

using namespace ricochet;

/// Wood, Bossak and Zienkiewicz's scheme, the α-method that weights inertia alone: α_m = (ρ−1)/(ρ+1), γ = ½ − α_m,
/// β = ¼(1 − α_m)². At ρ = 1 it is Newmark (¼, ½).
class WoodBossakZienkiewicz final : public TimeScheme {
 public:
  explicit WoodBossakZienkiewicz(double rho) {
    method_.mass = (rho - 1) / (rho + 1);
    method_.gamma = 0.5 - method_.mass;
    method_.beta = 0.25 * (1 - method_.mass) * (1 - method_.mass);
  }

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    StepPlan plan = method_.plan(h, facts);
    method_.add_filtered_energy(plan, h);
    if (method_.mass != 0) return plan;
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    plan.stages[0].work = {.displacement = method_.increment(h),
                           .rate = v + h / 4 * a + h / 4 * z,
                           .load = 0.5 * at(0) + 0.5 * at(1),
                           .effort = {0.5, 0.5}};
    return plan;
  }

 private:
  AlphaMethod method_;
};

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
      [](const Parameters& p) { return std::make_unique<WoodBossakZienkiewicz>(p.real("rho_inf")); });
}

}  // namespace

RICOCHET_PLUGIN(time, wbz_alpha, register_wbz_alpha)
