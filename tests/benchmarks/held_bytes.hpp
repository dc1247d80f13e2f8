#pragma once
#include <malloc.h>

namespace ricochet::benchmarks {

/// Bytes that this process has taken from the heap and not given back.
inline double held_bytes() {
  const struct mallinfo2 now = mallinfo2();
  return static_cast<double>(now.uordblks) + static_cast<double>(now.hblkhd);
}

}  // namespace ricochet::benchmarks
