#pragma once
#include <limits>
#include <ricochet/contract/float_control.hpp>

namespace ricochet {

/// A stop that is never reached, a bound that bounds nothing.
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Numbers of this thread are those of a march for as long as it lives, whatever was set before: rounded to nearest,
/// and denormal numbers count as zero. Then the control word is what it was. A mode that viscosity or the scheme has
/// killed decays below 2.2e-308. Each operation there costs a hundred times as much, and no digit of any result is at
/// stake. Scopes nest; threads know nothing of each other's.
class FlushDenormals {
 public:
  FlushDenormals() noexcept { set_float_control(marching_control()); }

 private:
  KeepFloatControl before_;
};

}  // namespace ricochet
