#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "runners/march/case_watch.hpp"

namespace ricochet {

/// A call of a plugin's function that has not returned yet.
struct LongCall {
  TicketPointer ticket;
  std::string plugin, function;  ///< "contact 'x' (file)", "solve"
  double seconds = 0;            ///< since it was first seen
  /// "plugin contact 'x' (file), solve() has not returned for 12 s".
  std::string text() const;
};

/// What the watching thread reports; called on it, and must not throw.
struct WatchHooks {
  /// A call took longer than its case may: the case is given up, and its thread with it. `worker`: the ticket of the
  /// thread's own case, where it worked for another one (a reference that serves both).
  std::function<void(const LongCall&, const TicketPointer& worker)> given_up;
  /// Now and then: the calls that are under way for more than two seconds.
  std::function<void(const std::vector<LongCall>&)> waiting;
  /// Stopped, and nobody comes back any more: the calls that keep them.
  std::function<void(const std::vector<LongCall>&)> left_behind;
};

/// Runs `body` on `threads` threads of their own until each has returned; it works for one case after the other, each
/// in its CaseScope. A case with a budget is given up once a call of a plugin's function has lasted longer than that,
/// and longer than 2 s: its thread is left alone for good, and another one calls `body` in its place. (Time is the
/// thread's processor time, or a tenth of what passes; a reference's own functions have no such limit.) After `stop`,
/// threads that are still in such a call after 3 s are left as well. `body` must not throw, and what it uses must live
/// until the program ends.
void run_watched(int threads, const std::function<void()>& body, const std::atomic<bool>& stop,
                 const WatchHooks& hooks);

/// Threads that were left in a plugin's function since the program began. Where there are any, the program can only end
/// by _exit().
int threads_left_behind();

}  // namespace ricochet
