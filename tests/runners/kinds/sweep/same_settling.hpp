#pragma once
#include <ricochet/measure/orbits/recurrence.hpp>

/// Whether two settlings have seen the same, bit for bit.
inline bool same_settling(const ricochet::Settling& a, const ricochet::Settling& b) {
  return a.scale == b.scale && a.tolerance == b.tolerance && a.longest == b.longest && a.ring == b.ring &&
         a.repeats == b.repeats && a.periods == b.periods;
}
