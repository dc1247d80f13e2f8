#pragma once
#include <limits>

namespace ricochet {

/// A stop that is never reached, a bound that bounds nothing.
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace ricochet
