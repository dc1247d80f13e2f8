#pragma once
#include "runners/kinds/kind.hpp"

namespace ricochet {

/// Each case goes through a parameter: sections, classes, exponents of its orbits from several starts.
Kind bifurcation_kind();

}  // namespace ricochet
