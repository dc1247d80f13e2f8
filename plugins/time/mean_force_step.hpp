#pragma once
#include <ricochet/contract/plugin.hpp>

/// \file
/// Steps in which an effort is the mean force of the step: it changes the momentum by h p.
namespace ricochet {

/// The mean of slot `from` before the stage and of what it becomes.
inline Combination halfway(Combination to, std::size_t from) {
  for (double& slot : to.slots) slot /= 2;
  to.slots[from] += 0.5;
  to.z /= 2;
  to.w /= 2;
  return to;
}

/// Where loads and rates of stops are taken: at both ends of the step, or half-way between them.
inline Levels both_ends() {
  return {{0, 0.5}, {1, 0.5}};
}
inline Levels middle() {
  return {{0.5, 1}};
}

/// Compliant laws asked at the end, in the middle, and at what is `known` of the middle.
inline void read_mean_force(Stage& stage, const Combination& end, const Combination& end_rate,
                            const Combination& mean_rate, const Combination& known, const Levels& at = both_ends()) {
  stage.at(Evaluation::implicit_end) = {end, {{1, 1}}, end_rate, {{1, 1}}, {1}};
  stage.at(Evaluation::averaged) = {halfway(end, 0), both_ends(), mean_rate, at, {1}};
  stage.at(Evaluation::explicit_start) = {known, {{0.5, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
}

/// Laws that conserve, for schemes whose contact gives p·H Δq.
inline void conserve_mean_force(Stage& stage, const Combination& end, const Combination& mean_rate,
                                const Levels& at = both_ends()) {
  stage.at(Evaluation::conserving) = {end, {{1, 1}}, mean_rate, at, {1}, Combination{.slots = {1}}, {{0, 1}}};
}

/// The balance of ½|v|²_M + ½|q|²_K, with the test displacement Δq.
inline void balance_mean_force(Stage& stage, const Combination& end, const Combination& mean_rate,
                               const Levels& at = both_ends()) {
  Combination way = end;
  way.slots[0] -= 1;
  stage.work = {.displacement = way, .rate = mean_rate, .load = at, .support = {{1, 1}, {0, -1}}};
}

/// The mid-point rule on positions and velocities, z = v_{n+1} − v_n, with F̄ = F(t+h/2) (`middle`) or the mean of both
/// ends, and the positions of its end between the stops:
///
///     (M/h + ½C + h/4 K) z = F̄ − C v − K(q + h/2 v) + Hᵀp
///     q ← q + h v + h/2 z,   v ← v + z,   y = H q_{n+1}
///
/// Invariant (undamped, free): ½|v|²_M + ½|q|²_K; test displacement q_{n+1} − q_n = h(v + z/2).
inline Stage mean_step(double h, const Levels& at) {
  Stage stage;
  stage.matrix = {1 / h, 0.5, h / 4};
  stage.history = {{0, 0, -1}, {0, -1, -h / 2}};
  stage.load = at;
  const Combination end{.slots = {1, h}, .z = h / 2}, end_rate{.slots = {0, 1}, .z = 1};
  const Combination mean_rate = halfway(end_rate, 1);
  stage.impact = {.value = end, .bound = {{1, 1}}};
  read_mean_force(stage, end, end_rate, mean_rate, {.slots = {1, h / 2}}, at);
  conserve_mean_force(stage, end, mean_rate, at);
  balance_mean_force(stage, end, mean_rate, at);
  stage.update = {end, end_rate};
  return stage;
}

/// A plan of such steps: slots q and v, energy and order; stages and other facts are the scheme's own.
inline StepPlan mean_step_plan() {
  StepPlan plan;
  plan.slots = {"q", "v"};
  plan.initial = {{1, 0}, {0, 1}};
  plan.velocity = {.slots = {0, 1}};
  plan.energy = {{EnergyMatrix::M, 0.5, {0, 1}}, {EnergyMatrix::K, 0.5, {1}}};
  plan.facts.order = 2;
  return plan;
}

/// M z = F(t + at·h) − C v − K q into the third slot: the acceleration of the structure alone.
inline Stage structure_acceleration(double at, std::size_t slots) {
  Stage stage;
  stage.matrix = {1, 0, 0};
  stage.history = {{0, 0, -1}, {0, -1, 0}};
  stage.load = {{at, 1}};
  for (std::size_t j = 0; j < slots; ++j) {
    stage.update.emplace_back().slots.resize(j + 1);
    stage.update[j].slots[j] = 1;
  }
  stage.update[2] = {.slots = {}, .z = 1};
  return stage;
}

}  // namespace ricochet
