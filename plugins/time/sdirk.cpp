#include <cmath>

#include "shared_steps.hpp"

namespace {

using namespace ricochet;
using namespace plan_algebra;

/// Singly diagonally implicit Runge–Kutta of two stages on (q, v), with one real double pole: both stages have the
/// matrix M + γhC + γ²h²K. With A = (γ, 0; s, γ), b = (b₁, b₂):
///
///     stage 1, z = a₁:   V₁ = v + γh a₁,              Q₁ = q + γh V₁
///     stage 2, z = a₂:   V₂ = v + s h a₁ + γh a₂,     Q₂ = q + s h V₁ + γh V₂
///     M aᵢ + C Vᵢ + K Qᵢ = F(t + cᵢh) + Hᵀp,          c = (γ, s + γ)
///     q ← q + h(b₁V₁ + b₂V₂),   v ← v + h(b₁a₁ + b₂a₂)
///
/// Order 2: γ = 1 − 1/√2, s = b₁ = 1 − γ, b₂ = γ. The second stage is the end of the step. High frequencies are gone in
/// one step. Order 3: γ = (3 + √3)/6, s = 1 − 2γ, b₁ = b₂ = ½. High frequencies keep √3 − 1 of their amplitude, with
/// the sign changed. Q₁ and q_{n+1} are kept between the stops. No energy in M and K alone is known.
PlanOrRefusal sdirk(const Parameters& p, double h, const ProblemFacts&) {
  const bool third = p.integer("order") == 3;
  const double gamma = third ? (3 + std::sqrt(3.0)) / 6 : 1 - std::sqrt(0.5), reach = gamma * h;
  const double s = third ? 1 - 2 * gamma : 1 - gamma, c2 = third ? s + gamma : 1;
  const double b1 = third ? 0.5 : 1 - gamma, b2 = third ? 0.5 : gamma;
  const auto [q, v, a] = slots<3>();
  Stage inner = motion_at(gamma, q + reach * v + reach * reach * z, v + reach * z);
  inner.impact = {.value = inner.update[0], .bound = at(gamma)};
  inner.update = {q, v, z};
  // Before it a is that of stage 1; V₁ = v + γh a.
  Stage outer =
      motion_at(c2, q + c2 * h * v + 2 * s * gamma * h * h * a + reach * reach * z, v + s * h * a + reach * z);
  const Combination end = q + h * v + (b1 * gamma + b2 * s) * h * h * a + b2 * gamma * h * h * z;
  outer.impact = {.value = end, .bound = at(1)};
  outer.update = {end, v + b1 * h * a + b2 * h * z, {}};
  inner.matrix = outer.matrix = M + gamma * h * C + gamma * gamma * h * h * K;
  // What is known of a rate before the solve is that of an earlier instant.
  inner.at(Evaluation::explicit_start)->rate_bound = at(0);
  outer.at(Evaluation::explicit_start)->rate_bound = at(s);
  StepPlan plan = plan_with({"q", "v", "a"});
  plan.stages = {inner, outer};
  plan.facts.order = third ? 3 : 2;
  return plan;
}

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
      sdirk);
}

}  // namespace

RICOCHET_PLUGIN(time, sdirk, register_sdirk)
