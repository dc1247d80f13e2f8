#pragma once
#include <ricochet/contract/plugin.hpp>

namespace ricochet {

/// The start stage of schemes with accelerations as their third slot,
///
///     M a₀ = F(0) − C v₀ − K q₀   (+ Hᵀp so that q₀ + d v₀ + d²/2 a₀ does not pass the stop of t + `bound` h).
///
/// On the kernel of a singular mass a₀ is not defined: `stiffening` K is added to M there, an O(h²) change of a₀ on the
/// regular modes.
inline Stage initial_acceleration(double d, double bound, double stiffening) {
  Stage stage;
  stage.matrix = {1, 0, stiffening};
  stage.history = {{0, 0, -1}, {0, -1, 0}};
  stage.load = {{0, 1}};
  stage.impact = {.value = {.slots = {1, d}, .z = 0.5 * d * d}, .bound = {{bound, 1}}};
  for (const auto evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    stage.at(evaluation) = {{.slots = {1}}, {{0, 1}}, {.slots = {0, 1}}, {{0, 1}}, {1}};
  stage.update = {{.slots = {1}}, {.slots = {0, 1}}, {.slots = {}, .z = 1}};
  return stage;
}

}  // namespace ricochet
