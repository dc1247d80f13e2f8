#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case follows periodic orbits of its scheme's own map along a parameter, stable or not, and locates their
/// special points.
KindPointer continuation_kind();

}  // namespace ricochet
