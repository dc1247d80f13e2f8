#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case is compared with a reference; orders of the errors in the step and in the element length.
KindPointer convergence_kind();

}  // namespace ricochet
