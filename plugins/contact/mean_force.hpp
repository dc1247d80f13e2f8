#pragma once
#include <array>
#include <cmath>

#include "power_law.hpp"

namespace ricochet {

/// The discrete gradient [U(δ) − U(δ⁻)]/(δ − δ⁻) of a law with stored(), force() and slope(), whose force changes over
/// lengths of `scale` (m) near both depths. Where they are closer than a fiftieth of that the difference would cancel,
/// and the mean of the force over the way is taken at five Gauss points, exact to round-off there.
template <class Law>
PointForce mean_force(const Law& law, double depth, double before, double scale) {
  constexpr double near = 0.02;
  const double change = depth - before;
  if (!(depth > 0 && before > 0) || std::abs(change) > near * scale) {
    PointForce mean;
    mean.value = (law.stored(depth) - law.stored(before)) / change;
    mean.stiffness = (law.force(depth) - mean.value) / change;
    mean.before = (mean.value - law.force(before)) / change;
    return mean;
  }
  // Of the interval from −1 to 1: node, weight/2.
  constexpr std::array<std::array<double, 2>, 5> points = {{{-0.906179845938663992797627, 0.118463442528094543757132},
                                                            {-0.538469310105683091036314, 0.239314335249683234020646},
                                                            {0, 0.284444444444444444444444},
                                                            {0.538469310105683091036314, 0.239314335249683234020646},
                                                            {0.906179845938663992797627, 0.118463442528094543757132}}};
  const double half = 0.5 * (depth + before);
  PointForce mean{.stiffness = 0.5 * law.slope(half), .before = 0.5 * law.slope(half)};
  for (const auto& [node, weight] : points) mean.value += weight * law.force(half + 0.5 * node * change);
  return mean;
}

}  // namespace ricochet
