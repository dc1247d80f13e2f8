#include <fmt/format.h>

#include <cmath>
#include <ricochet/contract/plugin.hpp>

namespace {

using namespace ricochet;

/// Newmark's scheme in acceleration form, z = a_{n+1}:
///
///     (M + γhC + βh²K) z = F(t+h) − C(v + (1−γ)h a) − K(q + h v + (½−β)h² a) + Hᵀp
///     q ← q + h v + (½−β)h² a + βh² z,   v ← v + (1−γ)h a + γh z,   a ← z,   y = H q_{n+1}
///
/// Energy (undamped, free): E = ½|v|²_M + ½|q|²_K + ½(β−γ/2)h²|a|²_M, of which a step takes
/// (γ−½)(|Δq|²_K + (β−γ/2)h²|Δa|²_M); test displacement q_{n+1} − q_n with the equations of both ends, γ and 1−γ.
class Newmark final : public TimeScheme {
 public:
  Newmark(double beta, double gamma) : beta_(beta), gamma_(gamma) {}

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const override {
    const bool unconditional = 2 * beta_ >= gamma_;
    if (facts.mass_kernel_dimension > 0 && !unconditional)
      return Refusal{
          fmt::format("beta = {:g} < gamma/2 = {:g} makes the kernel of a singular mass diverge at any step: "
                      "use beta ≥ gamma/2",
                      beta_, gamma_ / 2)};
    StepPlan plan;
    plan.slots = {"q", "v", "a"};
    plan.initial = {{1, 0}, {0, 1}, {0, 0}};
    plan.velocity = {.slots = {0, 1}};
    plan.start = {initial_acceleration(h, facts.mass_kernel_dimension > 0)};
    plan.stages = {step(h)};
    plan.energy = {{QuadraticTerm::Matrix::M, 0.5, {0, 1}},
                   {QuadraticTerm::Matrix::K, 0.5, {1}},
                   {QuadraticTerm::Matrix::M, 0.5 * (beta_ - gamma_ / 2) * h * h, {0, 0, 1}}};
    plan.facts.order = gamma_ == 0.5 ? 2 : 1;
    plan.facts.restitution = Restitution::ignored;
    plan.facts.needs_regular_mass = !unconditional;
    if (!unconditional) plan.facts.stability_limit = 1 / std::sqrt(gamma_ / 2 - beta_);
    return plan;
  }

 private:
  Combination end(double h) const { return {.slots = {1, h, (0.5 - beta_) * h * h}, .z = beta_ * h * h}; }

  Stage step(double h) const {
    Stage stage;
    const double lag = (1 - gamma_) * h, curve = (0.5 - beta_) * h * h;
    stage.matrix = {1, gamma_ * h, beta_ * h * h};
    stage.history = {{0, 0, -1}, {0, -1, -h}, {0, -lag, -curve}};
    stage.load = {{1, 1}};
    // Explicit: no effort moves q_{n+1}, which then is no measure of impact.
    if (beta_ > 0) stage.impact = {end(h), {{1, 1}}, std::nullopt};
    const Combination end_rate{.slots = {0, 1, lag}, .z = gamma_ * h};
    stage.at(Evaluation::implicit_end) = {end(h), {{1, 1}}, end_rate, {{1, 1}}, {1}};
    // The elastic force enters as K q_{n+1} alone, and so does the spring: averaging is done by the scheme's own
    // recurrence.
    stage.at(Evaluation::averaged) = stage.at(Evaluation::implicit_end);
    stage.at(Evaluation::explicit_start) = {{.slots = {1, h, curve}}, {{1, 1}}, {.slots = {0, 1, lag}}, {{1, 1}}, {1}};
    stage.update = {end(h), end_rate, {.slots = {}, .z = 1}};
    const Combination increment{.slots = {0, h, curve}, .z = beta_ * h * h};
    // With β < γ/2 what γ > ½ takes is no sum of squares: the balance is not known, the energy falls all the same.
    if (gamma_ != 0.5 && 2 * beta_ < gamma_) return stage;
    stage.work = {increment,
                  {.slots = {0, 1, gamma_ * lag}, .z = gamma_ * gamma_ * h},
                  {{0, 1 - gamma_}, {1, gamma_}},
                  {gamma_, 1 - gamma_}};
    // (γ−½)(|Δq|²_K + (β−γ/2)h²|Δa|²_M): what γ > ½ takes.
    if (gamma_ != 0.5) {
      const double taken = gamma_ - 0.5;
      stage.loss = {{EnergyMatrix::K, taken, increment},
                    {EnergyMatrix::M, taken * (beta_ - gamma_ / 2) * h * h, {.slots = {0, 0, -1}, .z = 1}}};
    }
    return stage;
  }

  // M a₀ = F(0) − C v₀ − K q₀ (+ Hᵀp so that the Taylor step does not pass a stop that the state rests on). On the
  // kernel of a singular mass a₀ is not defined: βh²K is added to M there, an O(h²) change of a₀ on the regular modes.
  Stage initial_acceleration(double h, bool singular_mass) const {
    Stage stage;
    stage.matrix = {1, 0, singular_mass ? beta_ * h * h : 0};
    stage.history = {{0, 0, -1}, {0, -1, 0}};
    stage.load = {{0, 1}};
    stage.impact = {{.slots = {1, h}, .z = 0.5 * h * h}, {{1, 1}}, std::nullopt};
    for (auto& compliance : stage.compliance) compliance = {{.slots = {1}}, {{0, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
    stage.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}};
    return stage;
  }

  double beta_, gamma_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "newmark",
       .summary = "Newmark (β, γ) with the multiplier inside the acceleration, stops at position level",
       .text =
           "The method of structural dynamics: equilibrium and non-penetration at the end of the step, q_{n+1} between "
           "the stops. The effort acts through the acceleration, hence on three levels with weights (β, ½+γ−2β, "
           "½−γ+β): a "
           "rigid impact leaves oscillating accelerations, and with β = ¼, γ = ½ the energy grows, the more the finer "
           "the "
           "step. It knows no restitution coefficient. Implicit and averaged penalties coincide.",
       .source = "Newmark (1959); Hughes (1987), The Finite Element Method, section 9.1; energy growth at contact: "
                 "Laursen and Chawla (1997)",
       .parameters = {real_parameter("beta", "1", 0.25, {.low = 0, .high = 0.5}, "β"),
                      real_parameter("gamma", "1", 0.5, {.low = 0.5, .high = 1},
                                     "γ; above ½ it damps, at first order")}},
      [](const Parameters& p) { return std::make_unique<Newmark>(p.real("beta"), p.real("gamma")); });
}

}  // namespace

RICOCHET_PLUGIN(time, newmark, register_all)
