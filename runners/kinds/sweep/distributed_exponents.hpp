#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include "runners/kinds/sweep/orbit_exponents.hpp"

namespace ricochet {

/// Measures batches of orbits of a task in other processes: `found` of each orbit is set, and `measured` told of each
/// batch that is complete. A batch whose process ends goes back orbit by orbit; an orbit that ends a process of its own
/// for the second time has no exponents, and task.lost says why. Adds the processor seconds.
void measure_elsewhere(const ForcedScenes& scenes, const ExponentTask& task, const SectionPlan& plan,
                       const std::vector<std::vector<std::size_t>>& batches, std::vector<OrbitExponents>& found,
                       double& seconds, const std::function<void(std::size_t batch)>& measured,
                       const std::atomic<bool>& stop);

}  // namespace ricochet
