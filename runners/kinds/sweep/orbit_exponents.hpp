#pragma once
#include <atomic>
#include <functional>
#include <ricochet/measure/orbits/lyapunov.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/march/case_context.hpp"

namespace ricochet {

/// Whether orbits with impacts have no exponents. Their tangents miss impacts, or there are none and twins miss them.
bool nothing_tells(const ForcedScenes& scenes, int group, const LaneSpec& lane);

/// Why saturated ones have none, and orbits with impacts where nothing_tells().
constexpr const char* why_saturated =
    "these methods have no derivative, and a twin is as far away as orbits are within one period";
constexpr const char* why_blind =
    "this scheme changes the velocity at the step that finds a point at its stop. The time of an impact moves with the "
    "orbit by whole steps alone. The derivative of the step and a twin nearby do not see this, and would call a "
    "chaotic orbit stable";

constexpr const char* why_superstable =
    "superstable: the mass comes to rest on its stop and leaves it whatever was before, so neighbours become one orbit "
    "(exponents −∞)";
constexpr const char* why_outlived =
    "tangents grow along these orbits, which repeat all the same: what the step leaves open of their impacts does not "
    "grow. Take more steps per period";
constexpr const char* why_untold =
    "impacts follow each other within a few steps, or at several points at once, and no point comes to rest of them. "
    "What they make of a neighbour is not known. Take more steps per period";

/// What the stability analysis says of roots of modulus one that are the scheme's.
struct MarginalRoots {
  std::string sentence;   ///< "" when there are none
  bool sawtooth = false;  ///< one of them is −1: a sawtooth of single steps
};
MarginalRoots marginal_roots(const ForcedScenes& scenes, int group);

/// What is measured, of which orbits.
struct ExponentTask {
  std::vector<const Orbit*> orbits;
  std::vector<int> groups;         ///< of each orbit
  std::vector<int> rounds;         ///< of each orbit, the periods after which it repeats; 0: not known
  std::vector<bool> sawtooth;      ///< per group: see MarginalRoots
  int count = 1;                   ///< exponents
  BlockService* blocks = nullptr;  ///< other processes that measure; null: the caller itself
  std::string case_id = {};        ///< for them
  std::vector<int> scenes = {};    ///< of each orbit, for them
  /// Told why an orbit has none: what ended the processes that measured it.
  std::function<void(const std::string&)> lost = {};
  /// Where batches outlive the program: find(number) gives what keep(number, batch) was given, or none. May be empty.
  std::function<std::vector<OrbitExponents>(std::size_t)> find;
  std::function<void(std::size_t, const std::vector<OrbitExponents>&)> keep;
};

/// Measures the exponents over the kept periods of each orbit, by tangent columns in blocks of lanes, and one twin
/// each. Adds the processor seconds. Throws Interrupted when `stop` becomes true.
std::vector<OrbitExponents> measure_exponents(const ForcedScenes& scenes, const ExponentTask& task,
                                              const SectionPlan& plan, double& seconds, const std::atomic<bool>& stop);

}  // namespace ricochet
