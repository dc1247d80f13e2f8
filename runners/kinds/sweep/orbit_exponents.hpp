#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <ricochet/measure/statistics/block_bootstrap.hpp>
#include <string>
#include <vector>

#include "runners/kinds/sweep/forced_scenes.hpp"
#include "runners/march/block_service.hpp"
#include "runners/march/thread_seats.hpp"

namespace ricochet {

/// The Lyapunov exponents of one orbit, 1/s, with 95 % block bootstrap intervals.
struct OrbitExponents {
  std::vector<Interval> values;  ///< largest first; those owed to the scheme set apart
  std::optional<Interval> twin;  ///< of the largest, by a twin trajectory
  std::string method;            ///< "tangent", "tangent+jump", "twin(1e-07)"; "" where none could be measured
  bool blind = false;            ///< none would see its impacts move: tangents_miss_impacts()
  bool saturated = false;        ///< there are no tangents, and the twin is soon as far away as orbits are
};

/// Why saturated ones have none, and orbits with impacts where tangents_miss_impacts().
constexpr const char* why_saturated =
    "these methods have no derivative, and a twin is as far away as orbits are within one period";
constexpr const char* why_blind =
    "this scheme changes the velocity at the step that finds a point at its stop, and the time of an impact moves with "
    "the orbit by whole steps alone; the derivative of the step and a twin nearby do not see it, and would call a "
    "chaotic orbit stable";

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
  std::vector<bool> sawtooth;      ///< per group: see MarginalRoots
  int count = 1;                   ///< exponents
  ThreadSeats* seats = nullptr;    ///< of threads that may measure; null: the caller alone
  BlockService* blocks = nullptr;  ///< other processes that measure; null: threads of this one
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
