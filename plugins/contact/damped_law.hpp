#pragma once
#include "power_law.hpp"

namespace ricochet {

/// p = f (1 + χ δ̇)₊ with an elastic force f, k δⁿ or its mean over a step: it grows with the speed of closing, never
/// pulls, and starts and ends at zero.
inline PointForce damped(const PointForce& elastic, double chi, double rate) {
  const double factor = 1 + chi * rate;
  PointForce force;
  // What is not given back: (p − f) δ̇.
  if (factor > 0) {
    force.value = elastic.value * factor;
    force.stiffness = elastic.stiffness * factor;
    force.before = elastic.before * factor;
    force.viscosity = elastic.value * chi;
    force.dissipation = elastic.value * chi * rate * rate;
  } else {
    force.dissipation = -elastic.value * rate;
  }
  return force;
}

/// What `evaluation` means for a law that damps.
inline constexpr const char* damped_evaluation_text =
    "`evaluation` says where in the step depth and speed are taken: implicit at its end, averaged over the levels over "
    "which the scheme averages the elastic force, explicit at what is known when it begins; midpoint half-way between "
    "the depths before and after the step, hybrid the same where the step begins in contact and else half of the force "
    "at its end, conserving with the elastic part by the difference of its energy over the step, which then comes back "
    "to round-off but for what is reported as dissipated; these with the mean speed over the step. ";

}  // namespace ricochet
