#pragma once
#include <atomic>

namespace ricochet {

/// The exit code of a run that was interrupted, of the shell's own convention: 128 + SIGINT.
inline constexpr int kInterrupted = 130;

/// While it lives, SIGINT, SIGTERM and SIGUSR1 (which schedulers send before a time limit) set `requested()` instead of
/// ending the program; a second SIGINT or SIGTERM ends it at once with code 130. SIGXFSZ is ignored, so that a file
/// size limit is an error of the write that meets it. The former handlers come back at the end. One at a time per
/// process.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  /// Also set by the program itself when going on makes no sense.
  std::atomic<bool>& requested() const;
};

}  // namespace ricochet
