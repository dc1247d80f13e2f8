#pragma once
#include <array>
#include <cmath>

namespace ricochet {

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

}  // namespace ricochet
