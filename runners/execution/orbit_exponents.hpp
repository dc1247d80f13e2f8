#pragma once
#include <atomic>
#include <optional>
#include <ricochet/measure/block_bootstrap.hpp>
#include <string>
#include <vector>

#include "runners/execution/forced_scenes.hpp"

namespace ricochet {

/// The Lyapunov exponents of one orbit, 1/s, with 95 % block bootstrap intervals.
struct OrbitExponents {
  std::vector<Interval> values;  ///< largest first; those owed to the scheme set apart
  std::optional<Interval> twin;  ///< of the largest, by a twin trajectory
  std::string method;            ///< "tangent", "tangent+jump", "twin(1e-07)"; "" where none could be measured
  std::string cause;             ///< why not
};

/// What the stability analysis says of roots of modulus one that are the scheme's.
struct MarginalRoots {
  std::string sentence;   ///< "" when there are none
  bool sawtooth = false;  ///< one of them is −1: a sawtooth of single steps
};
MarginalRoots marginal_roots(const ForcedScenes& scenes, int group);

/// Measures `count` exponents over the kept periods of each orbit, by tangent columns in blocks of lanes (and one twin
/// each), on `workers` threads. Throws Interrupted when `stop` becomes true.
std::vector<OrbitExponents> measure_exponents(const ForcedScenes& scenes, const std::vector<const Orbit*>& orbits,
                                              const std::vector<int>& groups, const SectionPlan& plan, int count,
                                              const std::vector<bool>& sawtooth, int workers, double& seconds,
                                              const std::atomic<bool>& stop);

}  // namespace ricochet
