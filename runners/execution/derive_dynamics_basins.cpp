#include "runners/execution/derive_dynamics_parts.hpp"

namespace ricochet::dynamics {

void derive_basins(StudyResults&) {}

}  // namespace ricochet::dynamics
