#include <cmath>
#include <ricochet/contract/plugin.hpp>

#include "shared_steps.hpp"

namespace {

using namespace ricochet;

/// Singly diagonally implicit Runge–Kutta of two stages on (q, v), with one real double pole: both stages have the
/// matrix M + γhC + γ²h²K. With A = (γ, 0; s, γ), b = (b₁, b₂):
///
///     stage 1, z = a₁:   V₁ = v + γh a₁,              Q₁ = q + γh V₁
///     stage 2, z = a₂:   V₂ = v + s h a₁ + γh a₂,     Q₂ = q + s h V₁ + γh V₂
///     M aᵢ + C Vᵢ + K Qᵢ = F(t + cᵢh) + Hᵀp,          c = (γ, s + γ)
///     q ← q + h(b₁V₁ + b₂V₂),   v ← v + h(b₁a₁ + b₂a₂)
///
/// Order 2: γ = 1 − 1/√2, s = b₁ = 1 − γ, b₂ = γ: the second stage is the end of the step, high frequencies are gone in
/// one step. Order 3: γ = (3 + √3)/6, s = 1 − 2γ, b₁ = b₂ = ½: they keep √3 − 1 of their amplitude, with the sign
/// changed. Q₁ and q_{n+1} are kept between the stops. No energy in M and K alone is known.
class Sdirk final : public TimeScheme {
 public:
  explicit Sdirk(bool third) : third_(third) {
    gamma_ = third ? (3 + std::sqrt(3.0)) / 6 : 1 - std::sqrt(0.5);
    shared_ = third ? 1 - 2 * gamma_ : 1 - gamma_;
    first_ = third ? 0.5 : 1 - gamma_;
    second_ = third ? 0.5 : gamma_;
  }

  PlanOrRefusal plan(double h, const ProblemFacts&) const override {
    StepPlan plan = plan_with({"q", "v", "a"});
    plan.stages = {inner(h), outer(h)};
    plan.facts.order = third_ ? 3 : 2;
    return plan;
  }

 private:
  Stage inner(double h) const {
    using namespace plan_algebra;
    const auto [q, v] = slots<2>();
    const double reach = gamma_ * h;
    const Combination position = q + reach * v + reach * reach * z, rate = v + reach * z;
    Stage stage = asked(h, gamma_, 0, position, rate);
    stage.impact = {.value = position, .bound = at(gamma_)};
    stage.update = {q, v, z};
    return stage;
  }

  // Before it a is that of stage 1; V₁ = v + γh a.
  Stage outer(double h) const {
    using namespace plan_algebra;
    const auto [q, v, a] = slots<3>();
    const double reach = gamma_ * h, now = third_ ? shared_ + gamma_ : 1;
    const Combination position = q + now * h * v + 2 * shared_ * gamma_ * h * h * a + reach * reach * z;
    Stage stage = asked(h, now, shared_, position, v + shared_ * h * a + reach * z);
    const Combination end =
        q + h * v + (first_ * gamma_ + second_ * shared_) * h * h * a + second_ * gamma_ * h * h * z;
    stage.impact = {.value = end, .bound = at(1)};
    stage.update = {end, v + first_ * h * a + second_ * h * z, {}};
    return stage;
  }

  // The equation of a stage that stands at position, rate; a spring is asked where the elastic force is. What is known
  // of the rate before the solve is that of the instant `behind`.
  Stage asked(double h, double now, double behind, const Combination& position, const Combination& rate) const {
    using namespace plan_algebra;
    Stage stage;
    stage.matrix = M + gamma_ * h * C + gamma_ * gamma_ * h * h * K;
    stage.history = -(C * rate) - K * position;
    stage.load = at(now);
    stage.at(Evaluation::implicit_end) = stage.at(Evaluation::averaged) = {position, at(now), rate, at(now), {1}};
    stage.at(Evaluation::explicit_start) = {known(position), at(now), known(rate), at(behind), {1}};
    return stage;
  }

  bool third_;
  double gamma_, shared_, first_, second_;
};

void register_sdirk(Registry& registry) {
  registry.add_time(
      {.name = "sdirk",
       .summary = "two implicit Runge–Kutta stages with one matrix, of order 2 (L-stable) or 3",
       .text = R"(Two solves per step with the same factorisation. Order 2 forgets the highest frequencies in one
          step, as backward Euler does, at second order; order 3 is A-stable and keeps 0.73 of them, with the sign
          changed. Stops are at position level, at the first stage and at the end of the step. Implicit and averaged
          penalties coincide.)",
       .source =
           "Alexander (1977), Diagonally implicit Runge–Kutta methods for stiff O.D.E.'s; order 3: Nørsett (1974)",
       .parameters = {integer_parameter("order", 2, {.low = 2, .high = 3}, "2: L-stable; 3: A-stable")},
       .words = "SDIRK"},
      [](const Parameters& p) { return std::make_unique<Sdirk>(p.integer("order") == 3); });
}

}  // namespace

RICOCHET_PLUGIN(time, sdirk, register_sdirk)
