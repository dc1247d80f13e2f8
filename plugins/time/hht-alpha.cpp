#include "alpha_method.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Hilber, Hughes and Taylor's scheme, the α-method that weights forces alone: a = −α = α_f, γ = ½ + a, β = (1 + a)²/4.
/// With d = q_n − q_{n−1}, Δd and Δa its change and that of a, the energy (undamped, free)
///
///     E = ½|v|²_M + ½|q|²_K + ⅛a²h²|a|²_M + ½a(½−a)|d|²_K,     −ΔE = ¼a³h²|Δa|²_M + ½a(½−a)|Δd|²_K
///
/// never grows; test displacement q_{n+1} − q_n with the equations of both ends, ½+a and ½−a. Those of the step before
/// need its velocity (slot u, where there is damping) and its load; the start rule weights its load alike.
PlanOrRefusal hht_alpha(const Parameters& p, double h, const ProblemFacts& facts) {
  const double a = 0 - p.real("alpha");
  const AlphaMethod method{.force = a,
                           .beta = 0.25 * (1 + a) * (1 + a),
                           .gamma = 0.5 + a,
                           .weighted_contact = p.word("contact") == "weighted"};
  StepPlan plan = method.plan(h, facts);
  Stage& step = plan.stages[0];
  method.balance_both_ends(step, h, 0.5 + a, 0.5 - a);
  if (a == 0) return plan;
  const auto [q, v, acceleration, d, u] = slots<5>();
  plan.start[0].load = method.now() * at(0) + a * at(-1);
  plan.energy.push_back(square(EnergyMatrix::M, 0.125 * a * a * h * h, acceleration));
  plan.energy.push_back(square(EnergyMatrix::K, 0.5 * a * (0.5 - a), d));
  step.loss = {{EnergyMatrix::M, 0.25 * a * a * a * h * h, z - acceleration},
               {EnergyMatrix::K, 0.5 * a * (0.5 - a), method.increment(h) - d}};
  AlphaMethod::add_slot(plan, "d", {0, 0}, method.increment(h));
  if (!facts.damped) return plan;
  AlphaMethod::add_slot(plan, "u", {0, 1}, v);
  step.work->rate = step.work->rate + (0.5 - a) * a * (u - v);
  return plan;
}

void register_hht_alpha(Registry& registry) {
  registry.add_time(
      {.name = "hht-alpha",
       .summary = "Hilber–Hughes–Taylor α: Newmark that damps high frequencies at second order",
       .text = R"(Newmark's updates with γ = ½ − α, β = (1−α)²/4, and elastic, viscous and applied forces weighted
          1+α and −α over both ends of the step: of second order, unconditionally stable, the highest frequencies
          shrink by (1+α)/(1−α) per step. α = 0 is Newmark (¼, ½). Stops are at position level, and a massed point
          is thrown back faster than it came (up to 2.3 times at α = −0.1): energy grows at impacts. On a singular
          mass the force is clean, and the damping takes the sawtooth that Newmark leaves there.)",
       .source = R"(Hilber, Hughes and Taylor (1977), Improved numerical dissipation for time integration algorithms
          in structural dynamics; Hughes (1987), The Finite Element Method, section 9.3)",
       .parameters = {real_parameter("alpha", "1", -0.1, {.low = -1.0 / 3, .high = 0}, "α; 0 does not damp"),
                      word_parameter("contact", {"end", "weighted"}, "end",
                                     R"(how a rigid effort enters: end, whole; weighted, as internal forces (1+α now,
          −α of the one before))")},
       .words = "HHT"},
      hht_alpha);
}

}  // namespace

RICOCHET_PLUGIN(time, hht_alpha, register_hht_alpha)
