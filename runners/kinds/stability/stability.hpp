#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case goes through a range of steps: spectral radius of the step, and what marching it shows.
Kind stability_kind();

}  // namespace ricochet
