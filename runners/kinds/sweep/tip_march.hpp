#pragma once
#include <functional>
#include <ricochet/engine/marcher.hpp>
#include <vector>

#include "runners/kinds/sweep/forced_scenes.hpp"

namespace ricochet {

/// A march of orbits again from where their kept periods began, one step after a strobe, that reads the tips.
class TipMarch {
 public:
  /// The program has a lane for each orbit.
  TipMarch(Program program, const std::vector<const Orbit*>& orbits, const SectionPlan& plan);

  /// The tip of a lane, `step` steps after the strobe: displacement and velocity, central over two steps.
  using Use = std::function<void(std::size_t lane, long long step, double displacement, double velocity)>;
  /// Marches on and hands over what stands one step back, from the second step after the strobe.
  void march(long long steps, const Use& use);
  /// Turns the clock back to the beginning of a period, as a run does after each.
  void turn_back() { marcher_.set_clock(begin_); }
  double h() const { return marcher_.program().h; }

 private:
  Marcher marcher_;
  long long begin_, made_ = 1;       // of the clock; steps since the strobe
  std::vector<double> before_, at_;  // tips per lane
};

}  // namespace ricochet
