#pragma once
#include <cmath>
#include <ricochet/contract/reference.hpp>

namespace ricochet::reference {

/// Displacement, strain and velocity at one place of a bar.
struct BarPoint {
  double displacement = 0, strain = 0, velocity = 0;
};

/// A bar seen from its free end: x there is `from_tip` (m).
struct BarFrame {
  double length = 1, stiffness = 1, inertia = 1;  ///< m, N (EA), kg/m (ρA)
  bool tip_left = true;                           ///< the tip is x = 0, else x = L
  double speed() const { return std::sqrt(stiffness / inertia); }
  double from_tip(double x) const { return tip_left ? x : length - x; }
  /// Strain in x, from strain in the distance to the tip.
  double strain(double towards) const { return tip_left ? towards : -towards; }
};

/// Fills tip and fields from `point(distance to the tip, t)`.
template <class Point>
void sample_bar(const BarFrame& bar, const SampleGrid& grid, const Point& point, SampledMotion& motion) {
  for (const double t : grid.times) {
    const BarPoint tip = point(0.0, t);
    motion.tip.push_back(tip.displacement);
    motion.tip_velocity.push_back(tip.velocity);
    for (const double x : grid.places) {
      const BarPoint here = point(bar.from_tip(x), t);
      motion.displacement.push_back(here.displacement);
      motion.strain.push_back(bar.strain(here.strain));
      motion.velocity.push_back(here.velocity);
    }
  }
}

}  // namespace ricochet::reference
