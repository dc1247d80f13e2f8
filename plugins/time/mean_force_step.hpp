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

/// Compliant laws asked at the end, in the middle, and at what is `known` of the middle.
inline void read_mean_force(Stage& stage, const Combination& end, const Combination& end_rate,
                            const Combination& mean_rate, const Combination& known) {
  stage.at(Evaluation::implicit_end) = {end, {{1, 1}}, end_rate, {{1, 1}}, {1}};
  stage.at(Evaluation::averaged) = {halfway(end, 0), {{0, 0.5}, {1, 0.5}}, mean_rate, {{0, 0.5}, {1, 0.5}}, {1}};
  stage.at(Evaluation::explicit_start) = {known, {{0.5, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
}

/// Laws that conserve, for schemes whose contact gives p·H Δq.
inline void conserve_mean_force(Stage& stage, const Combination& end, const Combination& mean_rate) {
  stage.at(Evaluation::conserving) = {
      end, {{1, 1}}, mean_rate, {{0, 0.5}, {1, 0.5}}, {1}, Combination{.slots = {1}}, {{0, 1}}};
}

/// The balance of ½|v|²_M + ½|q|²_K, with the test displacement Δq.
inline void balance_mean_force(Stage& stage, const Combination& end, const Combination& mean_rate) {
  Combination way = end;
  way.slots[0] -= 1;
  stage.work = {.displacement = way, .rate = mean_rate, .load = {{0, 0.5}, {1, 0.5}}, .support = {{1, 1}, {0, -1}}};
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
