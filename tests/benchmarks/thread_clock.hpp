#pragma once
#include <ctime>

namespace ricochet::benchmarks {

/// Processor time of this thread: what others do on the machine counts only where they share the core.
inline double thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

}  // namespace ricochet::benchmarks
