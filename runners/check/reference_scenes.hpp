#pragma once
#include <functional>
#include <memory>
#include <ricochet/contract/reference.hpp>
#include <string>
#include <vector>

#include "runners/check/parameter_values.hpp"

namespace ricochet::checking {

using Reference = Subject<ReferenceSolver>;

/// A scene that a reference is asked about, with the matrices of a mesh for those that need them.
struct ReferenceScene {
  std::string name;
  ReferenceProblem problem;
  SampleGrid grid;
  double tip = 0;                       ///< where it is, m
  std::function<double(double)> exact;  ///< its displacement where a closed form is known here, else empty
  std::shared_ptr<const DiscreteProblem> discrete;
};

/// A free oscillator, a forced one, a bouncing one, a bar on its stop, a cantilever against a stop.
std::vector<ReferenceScene> reference_scenes();

}  // namespace ricochet::checking
