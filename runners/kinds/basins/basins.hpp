#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case goes through a grid of two parameters: the end of the orbit of each cell.
Kind basins_kind();

}  // namespace ricochet
