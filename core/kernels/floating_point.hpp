#pragma once
#include <limits>
#include <ricochet/loader/float_control.hpp>

namespace ricochet {

/// A stop that is never reached, a bound that bounds nothing.
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Denormal numbers count as zero in this thread for as long as it lives; then the control word is what it was before.
/// A mode that viscosity or the scheme has killed decays below 2.2e-308. Each operation there costs a hundred times as
/// much, and no digit of any result is at stake. Scopes nest; threads know nothing of each other's.
class FlushDenormals {
 public:
  FlushDenormals() noexcept { set_float_control(float_control() | flushing_bits()); }

 private:
  KeepFloatControl before_;
};

}  // namespace ricochet
