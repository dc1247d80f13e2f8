#pragma once
#include <vector>

namespace ricochet {

/// What one lane carries from step to step, in model coordinates: enough to go on elsewhere with the same bits.
struct LaneState {
  std::vector<double> slots;    ///< slot by slot
  std::vector<double> efforts;  ///< per stage its p, and those of steps before where the plan weights them
  std::vector<double> fastest;  ///< per stage with a gate: the largest speed seen at its stops, m/s
  std::vector<double> memory;   ///< of the law, per point
};

}  // namespace ricochet
