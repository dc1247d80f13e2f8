#pragma once
#include <time.h>

#include <chrono>

namespace ricochet {

/// Processor time of this thread: what a case costs, whatever else the machine does. A case runs on one thread from
/// start to end.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Wall time since then, on a clock that nobody sets.
inline double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace ricochet
