#include "alpha_method.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Chung and Hulbert's scheme, the α-method with both its weights: α_m = (2ρ−1)/(ρ+1), α_f = ρ/(ρ+1), γ = ½ − α_m +
/// α_f, β = ¼(1 − α_m + α_f)². At ρ = 1 both weights are ½: the trapezium on accelerations. Its energy is ½|v|²_M +
/// ½|q|²_K, its test displacement q_{n+1} − q_n, and contact gives p(bound − H q_n) ≤ 0. Below ρ = 1 the energy has the
/// filtered increment σ (alpha_method.hpp). No balance is known there: the scheme answers a load with its past as well.
PlanOrRefusal generalised_alpha(const Parameters& p, double h, const ProblemFacts& facts) {
  AlphaMethod method = AlphaMethod::chung_hulbert(p.real("rho_inf"));
  method.weighted_contact = p.word("contact") == "weighted";
  const auto [q, v, a] = slots<3>();
  StepPlan plan = method.plan(h, facts);
  method.add_filtered_energy(plan, h);
  Stage& step = plan.stages[0];
  step.at(Evaluation::explicit_start) = method.asked_early(h);
  if (method.force != method.mass) return plan;
  plan.start[0].at(Evaluation::conserving) = {q, at(0), v, at(0), {1}, q, at(0)};
  const Combination mean_rate = v + h / 4 * a + h / 4 * z;
  conserve_mean_force(step, method.end(h), mean_rate, middle());
  balance_mean_force(step, method.end(h), mean_rate);
  plan.facts.contact_never_gains = !method.weighted_contact;
  return plan;
}

void register_generalised_alpha(Registry& registry) {
  registry.add_time(
      {.name = "generalised-alpha",
       .summary = "Chung–Hulbert α: second order, damping of high frequencies as asked, least of low ones",
       .text = R"(Newmark's updates, inertia and forces weighted over both ends of the step so that the highest
          frequencies keep ρ∞ of their amplitude per step: of second order, unconditionally stable. Stops are at
          position level. A massed point keeps none to 1 + ρ∞(1 − ρ∞) of its speed, at ρ∞ = 1 one half on average
          and never more than all of it; with contact among the weighted forces (contact weighted) up to 2.9 times.
          On a singular mass it is of second order through contact, with a clean force; ρ∞ = 1 leaves the root −1 on
          its kernel.)",
       .source = R"(Chung and Hulbert (1993), A time integration algorithm for structural dynamics with improved
          numerical dissipation: the generalized-α method)",
       .parameters = {real_parameter("rho_inf", "1", 0.8, {.low = 0, .high = 1},
                                     "ρ∞, what a step leaves of the highest frequencies; 1 does not damp"),
                      word_parameter("contact", {"end", "weighted"}, "end",
                                     R"(how a rigid effort enters: end, whole; weighted, as internal forces (1−α_f
          now, α_f of the one before))")},
       .words = "generalised α"},
      generalised_alpha);
}

}  // namespace

RICOCHET_PLUGIN(time, generalised_alpha, register_generalised_alpha)
