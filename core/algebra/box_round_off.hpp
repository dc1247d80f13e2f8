#pragma once
#include <algorithm>
#include <limits>

/// \file
/// What the sources of BoxSolver measure distances to bounds with.
namespace ricochet::box {

/// Round-off of a measure with k active points, relative to its terms.
inline double round_off(int k) {
  return 16 * (k + 1) * std::numeric_limits<double>::epsilon();
}

/// > 0 beyond.
inline double beyond_bounds(double y, double lower, double upper) {
  return std::max(lower - y, y - upper);
}

/// The terms of (2) that a point with the effort p adds to those without.
inline double complementarity(double y, double lower, double upper, double p, double diagonal) {
  return p > 0 ? std::min(diagonal * p, y - lower) : std::min(-diagonal * p, upper - y);
}

}  // namespace ricochet::box
