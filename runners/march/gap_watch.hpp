#pragma once
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// Looks at how far the points of one lane get beyond stops that are on both sides of them, beside the gap between
/// them. Points with a stop on one side, or without room between two, have no gap.
class GapWatch {
 public:
  explicit GapWatch(const Marcher& marcher);

  /// After a step at whose end some point is `penetration` (m) beyond its stop. Costs a comparison where that is within
  /// the smallest gap; no allocation.
  void see(const Marcher& marcher, double penetration) {
    if (penetration > looked_at_) look(marcher, penetration);
  }

  /// What the march did in steps too long for its gaps, a sentence each: a point comes to its stop with a speed that
  /// crosses the gap in a step; a point passes its stop by more than the gap. `recorder`: of the whole march.
  static std::string crossed(const Marcher& marcher, const ImpactRecorder& recorder);
  std::string passed() const;

 private:
  void look(const Marcher& marcher, double penetration);
  double looked_at_;  // m: no less is looked at; at first the smallest gap
  double times_ = 0, first_ = 0;
};

}  // namespace ricochet
