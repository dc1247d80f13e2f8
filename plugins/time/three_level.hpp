#pragma once
#include <cmath>
#include <ricochet/contract/said_format.hpp>

#include "shared_steps.hpp"

namespace ricochet {

/// The three-level β scheme in increment form. With d_n = q_n − q_{n−1} and z = q_{n+1} − 2q_n + q_{n−1}:
///
///     (M/h² + C/(2h) + βK) z = F^β − C d_n/h − K q_n + Hᵀp,   F^β = βF(t+h) + (1−2β)F(t) + βF(t−h)
///     y = H(q_{n+1} + e q_{n−1})/(1+e)
///
/// Invariant (undamped, free): E = ½|d/h|²_M + ½|q̄|²_K + ½(β−¼)|d|²_K, q̄ = q_n + d_{n+1}/2; the test displacement
/// (q_{n+1} − q_{n−1})/2 = d_n + z/2 gives its exact balance. Dumont and Paoli (2006); β = 0 is Paoli and Schatzman
/// (2002), and with e = 0 Carpenter, Taylor and Katona (1991).
struct ThreeLevel {
  double beta = 0;
  double e = 0;  ///< restitution
  bool second_order = true;

  PlanOrRefusal plan(double h, const ProblemFacts& facts) const {
    using namespace plan_algebra;
    if (facts.mass_kernel_dimension > 0 && beta == 0 && !facts.damped)
      return Refusal{
          "beta = 0 leaves S singular on the kernel of a singular mass: use beta ≥ 0.25 of newmark-dumont-paoli"};
    if (facts.mass_kernel_dimension > 0 && beta < 0.25)
      return Refusal{
          said("beta = {:g} < 0.25 makes the kernel of a singular mass diverge at any step (roots of βr² + "
               "(1−2β)r + β outside the unit circle). Use beta ≥ 0.25 of newmark-dumont-paoli",
               beta)};
    const auto [q, d] = slots<2>();
    StepPlan plan;
    plan.slots = {"q", "d"};
    plan.initial = {{1, 0}, {0, h}};
    plan.velocity = d / h;
    plan.stages = {step(h)};
    plan.start = {start(h)};
    plan.start_advances = true;
    plan.energy = {square(EnergyMatrix::M, 0.5 / (h * h), d), square(EnergyMatrix::K, 0.5, q - 0.5 * d),
                   square(EnergyMatrix::K, 0.5 * (beta - 0.25), d)};
    plan.facts = {.order = second_order ? 2.0 : 1.0,
                  .contact_order = 1,
                  .restitution = Restitution::asymptotic,
                  .needs_regular_mass = beta < 0.25,
                  .stability_limit = std::nullopt,
                  .contact_never_gains = e == 0};
    if (beta < 0.25) plan.facts.stability_limit = 2 / std::sqrt(1 - 4 * beta);
    return plan;
  }

 private:
  Levels mean_levels() const {
    using namespace plan_algebra;
    return beta * at(1) + (1 - 2 * beta) * at(0) + beta * at(-1);
  }

  Stage step(double h) const {
    using namespace plan_algebra;
    const auto [q, d] = slots<2>();
    const Combination next = q + d + z, before = q - d, rate = d / h + 0.5 / h * z;
    Stage stage = equation(M / (h * h) * z + C * rate + K * (q + beta * z), mean_levels());
    stage.impact = {(next + e * before) / (1 + e), 1 / (1 + e) * at(1) + e / (1 + e) * at(-1), std::nullopt};
    stage.at(Evaluation::implicit_end) = {next, at(1), rate, at(0), {1}};
    stage.at(Evaluation::averaged) = {next, at(1), rate, at(0), {beta, 1 - 2 * beta, beta}};
    stage.at(Evaluation::explicit_start) = {q, at(0), d / h, at(-0.5), {1}};
    // Mid-step displacements: their difference is the test displacement, and E + U(g) is kept.
    stage.at(Evaluation::conserving) = {halfway(q, next), 0.5 * at(0) + 0.5 * at(1), rate, at(0), {1},
                                        q - 0.5 * d,      0.5 * at(0) + 0.5 * at(-1)};
    stage.update = {next, d + z};
    stage.work = {d + 0.5 * z, rate, mean_levels(), {1}, 0.5 * at(1) - 0.5 * at(-1)};
    return stage;
  }

  // z = 2(q₁ − q₀ − h v₀), d holds h v₀. Second order: q₋₁ = q₁ − 2h v₀ inside the scheme's own equation, C acting on
  // v₀ alone. First order: no force acts, z is what rigid stops make it.
  Stage start(double h) const {
    using namespace plan_algebra;
    const auto [q, d] = slots<2>();
    const Combination first = q + d + 0.5 * z, rate = d / h;
    Stage stage;
    stage.matrix = M / (h * h) + beta * K;
    // There is no q₋₁ that contact may lean on. With e = 0 contact holds q₁. With e > 0 (q₁ − q₀)/h rebounds with −e v₀
    // where the free q₁ passes the stop.
    stage.impact = ImpactMeasure{first, at(1)};
    if (e > 0) stage.impact = {rate + 0.5 / h * z, at(0.5), VelocityGate{first, at(1), rate, at(0), e}};
    stage.update = {first, d + 0.5 * z};
    if (!second_order) return stage;
    stage.history = -(K * q) - C * rate;
    stage.load = mean_levels();
    stage.at(Evaluation::implicit_end) = stage.at(Evaluation::averaged) = {first, at(1), rate, at(0), {1}};
    stage.at(Evaluation::explicit_start) = {q, at(0), rate, at(0), {1}};
    // q₋₁ is taken as q₀ − h v₀: the difference is the first order's, and a start beyond a stop has no past anyway.
    stage.at(Evaluation::conserving) = {
        q + 0.5 * d + 0.25 * z, 0.5 * at(0) + 0.5 * at(1), rate, at(0), {1}, q - 0.5 * d, 0.5 * at(0) + 0.5 * at(-1)};
    return stage;
  }
};

}  // namespace ricochet
