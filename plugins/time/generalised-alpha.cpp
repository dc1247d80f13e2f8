#include <ricochet/contract/plugin.hpp>

#include "alpha_method.hpp"

namespace {

using namespace ricochet;

/// Chung and Hulbert's scheme, the α-method with both weights: α_m = (2ρ−1)/(ρ+1), α_f = ρ/(ρ+1), γ = ½ − α_m + α_f,
/// β = ¼(1 − α_m + α_f)². At ρ = 1 both weights are ½: the trapezium on accelerations, whose energy is ½|v|²_M +
/// ½|q|²_K and whose test displacement is q_{n+1} − q_n; contact then gives p(bound − H q_n) ≤ 0. Below ρ = 1 the
/// energy has the filtered increment σ (alpha_method.hpp), and the scheme answers a load with its past as well: no
/// balance is known.
class GeneralisedAlpha final : public TimeScheme {
 public:
  GeneralisedAlpha(double rho, bool weighted) : method_(AlphaMethod::chung_hulbert(rho)) {
    method_.weighted_contact = weighted;
  }

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    StepPlan plan = method_.plan(h, facts);
    method_.add_filtered_energy(plan, h);
    Stage& step = plan.stages[0];
    // Asked where the weighted forces stand, without the acceleration: that of the end would be fed back undamped.
    const double now = method_.now();
    step.at(Evaluation::explicit_start) = {q + now * h * v, at(now), v, at(0), {1}};
    if (method_.force != method_.mass) return plan;
    plan.start[0].at(Evaluation::conserving) = {q, at(0), v, at(0), {1}, q, at(0)};
    const Combination mean_rate = v + h / 4 * a + h / 4 * z;
    step.at(Evaluation::conserving) = {method_.end(h), at(1), mean_rate, at(0.5), {1}, q, at(0)};
    step.work = {.displacement = method_.increment(h),
                 .rate = mean_rate,
                 .load = 0.5 * at(0) + 0.5 * at(1),
                 .support = at(1) - at(0)};
    plan.facts.contact_never_gains = !method_.weighted_contact;
    return plan;
  }

 private:
  AlphaMethod method_;
};

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
      [](const Parameters& p) {
        return std::make_unique<GeneralisedAlpha>(p.real("rho_inf"), p.word("contact") == "weighted");
      });
}

}  // namespace

RICOCHET_PLUGIN(time, generalised_alpha, register_generalised_alpha)
