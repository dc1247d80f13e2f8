#pragma once
#include "power_law.hpp"

namespace ricochet {

/// p = k δⁿ (1 + χ δ̇)₊: a force that grows with the speed of closing, never pulls, and starts and ends at zero.
inline PointForce damped(const PowerLaw& law, double chi, const ContactState& state) {
  const double factor = 1 + chi * state.rate, elastic = law.force(state.depth);
  PointForce force;
  // What is not given back: (p − k δⁿ) δ̇.
  if (factor > 0) {
    force.value = elastic * factor;
    force.stiffness = law.slope(state.depth) * factor;
    force.viscosity = elastic * chi;
    force.dissipation = elastic * chi * state.rate * state.rate;
  } else {
    force.dissipation = -elastic * state.rate;
  }
  return force;
}

}  // namespace ricochet
