#include <ricochet/contract/plugin.hpp>

#include "alpha_method.hpp"

namespace {

using namespace ricochet;

/// Hilber, Hughes and Taylor's scheme, the α-method that weights forces alone: a = −α = α_f, γ = ½ + a, β = (1 + a)²/4.
/// With d = q_n − q_{n−1}, Δd and Δa its change and that of a, the energy (undamped, free)
///
///     E = ½|v|²_M + ½|q|²_K + ⅛a²h²|a|²_M + ½a(½−a)|d|²_K,     −ΔE = ¼a³h²|Δa|²_M + ½a(½−a)|Δd|²_K
///
/// never grows; test displacement q_{n+1} − q_n with the equations of both ends, ½+a and ½−a. Those of the step before
/// need its velocity (slot u, where there is damping) and its load; the start rule weights its load alike.
class HilberHughesTaylor final : public TimeScheme {
 public:
  HilberHughesTaylor(double alpha, bool weighted) : a_(0 - alpha) {
    method_.force = a_;
    method_.gamma = 0.5 + a_;
    method_.beta = 0.25 * (1 + a_) * (1 + a_);
    method_.weighted_contact = weighted;
  }

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    using namespace plan_algebra;
    const auto [q, v, a, d, u] = slots<5>();
    StepPlan plan = method_.plan(h, facts);
    Stage& step = plan.stages[0];
    balance(step, h);
    if (a_ == 0) return plan;
    plan.start[0].load = method_.now() * at(0) + a_ * at(-1);
    plan.energy.push_back(square(EnergyMatrix::M, 0.125 * a_ * a_ * h * h, a));
    plan.energy.push_back(square(EnergyMatrix::K, 0.5 * a_ * (0.5 - a_), d));
    AlphaMethod::add_slot(plan, "d", {0, 0}, method_.increment(h));
    if (facts.damped) {
      AlphaMethod::add_slot(plan, "u", {0, 1}, v);
      // Without the slot the share of the step before is counted at v_n: only damping sees it.
      step.work->rate = step.work->rate + (0.5 - a_) * a_ * (u - v);
    }
    return plan;
  }

 private:
  void balance(Stage& stage, double h) const {
    using namespace plan_algebra;
    const auto [q, v, a, d] = slots<4>();
    const double now = 0.5 + a_, before = 0.5 - a_, f = method_.now();
    const Combination rate =
        (now + before) * v + now * f * (method_.ahead_rate(h) - v) + now * f * method_.gamma * h * z;
    stage.work = {.displacement = method_.increment(h),
                  .rate = rate,
                  .load = (now * a_ + before * f) * at(0) + now * f * at(1),
                  .effort = {now, before}};
    if (a_ == 0) return;
    stage.work->load = stage.work->load + before * a_ * at(-1);
    stage.loss = {{EnergyMatrix::M, 0.25 * a_ * a_ * a_ * h * h, z - a},
                  {EnergyMatrix::K, 0.5 * a_ * (0.5 - a_), method_.increment(h) - d}};
  }

  double a_;
  AlphaMethod method_;
};

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
      [](const Parameters& p) {
        return std::make_unique<HilberHughesTaylor>(p.real("alpha"), p.word("contact") == "weighted");
      });
}

}  // namespace

RICOCHET_PLUGIN(time, hht_alpha, register_hht_alpha)
