#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case marches its scene once: energies, impacts, a curve over time.
Kind trajectory_kind();

}  // namespace ricochet
