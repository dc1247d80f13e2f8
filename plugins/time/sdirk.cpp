#include <cmath>
#include <ricochet/contract/plugin.hpp>

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
    StepPlan plan;
    plan.slots = {"q", "v", "a"};
    plan.initial = {{1, 0}, {0, 1}, {0, 0}};
    plan.velocity = {.slots = {0, 1}};
    plan.stages = {inner(h), outer(h)};
    plan.facts.order = third_ ? 3 : 2;
    return plan;
  }

 private:
  Stage inner(double h) const {
    const double reach = gamma_ * h;
    const Combination position{.slots = {1, reach}, .z = reach * reach}, rate{.slots = {0, 1}, .z = reach};
    Stage stage = asked(h, gamma_, 0, position, rate);
    stage.impact = {.value = position, .bound = {{gamma_, 1}}};
    stage.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}};
    return stage;
  }

  // Before it a is that of stage 1; V₁ = v + γh a.
  Stage outer(double h) const {
    const double reach = gamma_ * h, at = third_ ? shared_ + gamma_ : 1;
    const Combination position{.slots = {1, at * h, 2 * shared_ * gamma_ * h * h}, .z = reach * reach};
    const Combination rate{.slots = {0, 1, shared_ * h}, .z = reach};
    Stage stage = asked(h, at, shared_, position, rate);
    const double earlier = (first_ * gamma_ + second_ * shared_) * h * h;
    const Combination end{.slots = {1, h, earlier}, .z = second_ * gamma_ * h * h};
    stage.impact = {.value = end, .bound = {{1, 1}}};
    stage.update = {end, {.slots = {0, 1, first_ * h}, .z = second_ * h}, {}};
    return stage;
  }

  // The equation of a stage that stands at position, rate; a spring is asked where the elastic force is. What is known
  // of the rate before the solve is that of the instant `behind`.
  Stage asked(double h, double at, double behind, const Combination& position, const Combination& rate) const {
    Stage stage;
    stage.matrix = {1, gamma_ * h, gamma_ * gamma_ * h * h};
    for (std::size_t j = 0; j < position.slots.size(); ++j)
      stage.history.push_back({0, j < rate.slots.size() ? 0 - rate.slots[j] : 0.0, 0 - position.slots[j]});
    stage.load = {{at, 1}};
    stage.at(Evaluation::implicit_end) = {position, {{at, 1}}, rate, {{at, 1}}, {1}};
    stage.at(Evaluation::averaged) = stage.at(Evaluation::implicit_end);
    Combination known = position, known_rate = rate;
    known.z = known_rate.z = 0;
    stage.at(Evaluation::explicit_start) = {known, {{at, 1}}, known_rate, {{behind, 1}}, {1}};
    return stage;
  }

  bool third_;
  double gamma_, shared_, first_, second_;
};

void register_all(Registry& registry) {
  registry.add_time(
      {.name = "sdirk",
       .summary = "two implicit Runge–Kutta stages with one matrix, of order 2 (L-stable) or 3",
       .text = "Two solves per step with the same factorisation. Order 2 forgets the highest frequencies in one step, "
               "as backward Euler does, at second order; order 3 is A-stable and keeps 0.73 of them, with the sign "
               "changed. Stops are at position level, at the first stage and at the end of the step. Implicit and "
               "averaged penalties coincide.",
       .source =
           "Alexander (1977), Diagonally implicit Runge–Kutta methods for stiff O.D.E.'s; order 3: Nørsett (1974)",
       .parameters = {integer_parameter("order", 2, {.low = 2, .high = 3}, "2: L-stable; 3: A-stable")}},
      [](const Parameters& p) { return std::make_unique<Sdirk>(p.integer("order") == 3); });
}

}  // namespace

RICOCHET_PLUGIN(time, sdirk, register_all)
