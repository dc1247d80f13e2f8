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
  using namespace plan_algebra;
  const auto [q, v] = slots<2>();
  Stage stage;
  stage.matrix = M + stiffening * K;
  stage.history = -(K * q) - C * v;
  stage.load = at(0);
  stage.impact = {.value = q + d * v + 0.5 * d * d * z, .bound = at(bound)};
  for (const auto evaluation : {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start})
    stage.at(evaluation) = {q, at(0), v, at(0), {1}};
  stage.update = {q, v, z};
  return stage;
}

}  // namespace ricochet
