#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// As convergence, and each case is timed: error against processor time.
KindPointer work_precision_kind();

}  // namespace ricochet
