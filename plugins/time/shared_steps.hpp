#pragma once
#include <array>
#include <cmath>
#include <ricochet/contract/plugin.hpp>
#include <ricochet/contract/said_format.hpp>
#include <string_view>

/// \file
/// Stages and parts of stages that several schemes have.
namespace ricochet {

/// A plan whose slots are q, v and others that begin at zero; v is its velocity.
inline StepPlan plan_with(std::vector<std::string> slots) {
  StepPlan plan;
  plan.initial.assign(slots.size(), {0, 0});
  plan.initial[0] = {1, 0};
  plan.initial[1] = {0, 1};
  plan.velocity = plan_algebra::slots<2>()[1];
  plan.slots = std::move(slots);
  return plan;
}

/// The refusal of a singular mass by schemes that have `what` of contact points as a state.
inline Refusal needs_mass(const Said& what, std::string_view remedy = "use a lumped mass, or an implicit scheme") {
  return Refusal{said("{} needs the inverse of the mass, which is singular here: {}", what, remedy)};
}

/// e of Newton's law v⁺ = −e v⁻, from 0 to 1.
inline ParameterSpec restitution_parameter() {
  return with_role(
      real_parameter("restitution", "1", 0.0, {.low = 0, .high = 1}, "e, Newton's restitution coefficient"),
      ParameterRole::restitution);
}

/// The start stage of schemes with accelerations as their third slot,
///
///     M a₀ = F(0) − C v₀ − K q₀   (+ Hᵀp so that q₀ + d v₀ + d²/2 a₀ does not pass the stop of t + `bound` h).
///
/// Where the mass is singular a₀ is not defined on its kernel. Then `stiffening` K is added to M, an O(h²) change of a₀
/// on the regular modes.
inline Stage initial_acceleration(double d, double bound, double stiffening) {
  using namespace plan_algebra;
  const auto [q, v] = slots<2>();
  Stage stage = equation((M + stiffening * K) * z + C * v + K * q, at(0));
  stage.impact = {.value = q + d * v + 0.5 * d * d * z, .bound = at(bound)};
  for (const auto evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    stage.at(evaluation) = {q, at(0), v, at(0), {1}};
  stage.update = {q, v, z};
  return stage;
}

/// The equation of motion at the instant t + c h, z its acceleration,
///
///     M z + C rate + K position = F(t + c h) + Hᵀp,   q ← position,   v ← rate,   a ← z
///
/// The elastic force is that of one instant, and so is a spring: implicit and averaged laws coincide.
inline Stage motion_at(double c, const Combination& position, const Combination& rate) {
  using namespace plan_algebra;
  Stage stage = equation(M * z + C * rate + K * position, at(c));
  stage.at(Evaluation::implicit_end) = stage.at(Evaluation::averaged) = {position, at(c), rate, at(c), {1}};
  stage.at(Evaluation::explicit_start) = {known(position), at(c), known(rate), at(c), {1}};
  stage.update = {position, rate, z};
  return stage;
}

/// M z = F(t + c h) − C v − K q into the third of so many slots: the acceleration of the structure alone.
template <std::size_t count>
Stage structure_acceleration(double c) {
  using namespace plan_algebra;
  const auto all = slots<count>();
  Stage stage = equation(M * z + C * all[1] + K * all[0], at(c));
  stage.update.assign(all.begin(), all.end());
  stage.update[2] = z;
  return stage;
}

/// A position brought between the stops of t + h in the metric of the mass: M z/h² = Hᵀp, y = H(position + z).
inline Stage projection(double h, const Combination& position, std::vector<Combination> update) {
  using namespace plan_algebra;
  Stage stage = equation(M / (h * h) * z, {});
  stage.impact = {.value = position + z, .bound = at(1)};
  stage.update = std::move(update);
  return stage;
}

/// The smallest hω at which a root of a step leaves the unit circle, through −1 or as a pair. `step((hω)², q, v)` is
/// {q, v} of the undamped oscillator after the step h = 1.
template <class Step>
double stability_limit(const Step& step) {
  const auto stable = [&](double frequency) {
    const double squared = frequency * frequency;
    const std::array<double, 2> of_q = step(squared, 1.0, 0.0), of_v = step(squared, 0.0, 1.0);
    const double trace = of_q[0] + of_v[1], determinant = of_q[0] * of_v[1] - of_v[0] * of_q[1];
    constexpr double round_off = 1e-12;
    return determinant <= 1 + round_off && std::abs(trace) <= 1 + determinant + round_off;
  };
  constexpr double stride = 1e-2;
  double inside = stride;
  while (stable(inside + stride)) inside += stride;
  double outside = inside + stride;
  for (int k = 0; k < 60; ++k) (stable((inside + outside) / 2) ? inside : outside) = (inside + outside) / 2;
  return inside;
}

// Steps in which an effort is the mean force of the step: it changes the momentum by h p.

/// The mean of a slot before the stage and of what it becomes.
inline Combination halfway(const Combination& from, const Combination& to) {
  return to / 2 + 0.5 * from;
}

/// Where loads and rates of stops are taken: at both ends of the step, or half-way between them.
inline Levels both_ends() {
  using plan_algebra::at;
  return 0.5 * at(0) + 0.5 * at(1);
}
inline Levels middle() {
  return plan_algebra::at(0.5);
}

/// Compliant laws asked at the end, in the middle, and at what is `known` of the middle.
inline void read_mean_force(Stage& stage, const Combination& end, const Combination& end_rate,
                            const Combination& mean_rate, const Combination& known, const Levels& when = both_ends()) {
  using namespace plan_algebra;
  const auto [q, v] = slots<2>();
  stage.at(Evaluation::implicit_end) = {end, at(1), end_rate, at(1), {1}};
  stage.at(Evaluation::averaged) = {halfway(q, end), both_ends(), mean_rate, when, {1}};
  stage.at(Evaluation::explicit_start) = {known, at(0.5), v, at(0), {1}};
}

/// Laws that conserve, for schemes whose contact gives p·H Δq.
inline void conserve_mean_force(Stage& stage, const Combination& end, const Combination& mean_rate,
                                const Levels& when = both_ends()) {
  using namespace plan_algebra;
  stage.at(Evaluation::conserving) = {end, at(1), mean_rate, when, {1}, slots<1>()[0], at(0)};
}

/// The balance of ½|v|²_M + ½|q|²_K, with the test displacement Δq.
inline void balance_mean_force(Stage& stage, const Combination& end, const Combination& mean_rate,
                               const Levels& when = both_ends()) {
  using namespace plan_algebra;
  stage.work = {.displacement = end - slots<1>()[0], .rate = mean_rate, .load = when, .support = at(1) - at(0)};
}

/// The trapezium from q, v to `end`, `end_rate`. The load F̄ is F(t+h/2) (`middle`) or the mean of both ends. Positions
/// of its end lie between the stops:
///
///     M z/h + C (v + end_rate)/2 + K (q + end)/2 = F̄ + Hᵀp,   q ← end,   v ← end_rate,   y = H q_{n+1}
///
/// Invariant (undamped, free) where z = v_{n+1} − v_n and end = q + h(v + end_rate)/2: ½|v|²_M + ½|q|²_K, with the test
/// displacement q_{n+1} − q_n.
inline Stage mean_step(double h, const Levels& when, const Combination& end, const Combination& end_rate) {
  using namespace plan_algebra;
  const auto [q, v] = slots<2>();
  const Combination mean_rate = halfway(v, end_rate);
  Stage stage = equation(M / h * z + C * mean_rate + K * halfway(q, end), when);
  stage.impact = {.value = end, .bound = at(1)};
  read_mean_force(stage, end, end_rate, mean_rate, q + h / 2 * v, when);
  conserve_mean_force(stage, end, mean_rate, when);
  balance_mean_force(stage, end, mean_rate, when);
  stage.update = {end, end_rate};
  return stage;
}
/// The mid-point rule on positions and velocities, z = v_{n+1} − v_n:
///
///     (M/h + ½C + h/4 K) z = F̄ − C v − K(q + h/2 v) + Hᵀp,   q ← q + h v + h/2 z,   v ← v + z
inline Stage mean_step(double h, const Levels& when) {
  const auto [q, v] = plan_algebra::slots<2>();
  return mean_step(h, when, q + h * v + h / 2 * plan_algebra::z, v + plan_algebra::z);
}

/// A plan of such steps: slots q and v, energy and order; stages and other facts are the scheme's own.
inline StepPlan mean_step_plan() {
  const auto [q, v] = plan_algebra::slots<2>();
  StepPlan plan = plan_with({"q", "v"});
  plan.energy = {square(EnergyMatrix::M, 0.5, v), square(EnergyMatrix::K, 0.5, q)};
  plan.facts.order = 2;
  return plan;
}

}  // namespace ricochet
