#pragma once
#include <time.h>

#include <chrono>
#include <optional>
#include <ricochet/contract/plugin_call.hpp>
#include <string>

namespace ricochet {

/// A CallNote in memory that another process maps by its descriptor. Neither can make it smaller.
class NoteFile {
 public:
  /// `least`: the least number that its descriptor has. Throws RunError where there is no memory or number for it.
  explicit NoteFile(int least = 0);
  ~NoteFile();
  NoteFile(const NoteFile&) = delete;
  NoteFile& operator=(const NoteFile&) = delete;

  int descriptor() const { return descriptor_; }
  const CallNote& note() const { return *note_; }

 private:
  int descriptor_ = -1;
  CallNote* note_ = nullptr;
};

/// The note behind a descriptor of this process, which it closes: what a plugin writes to it does not come here. Throws
/// RunError.
CallNote* take_note(int descriptor);

/// A call of a plugin's function that has not returned yet.
struct LongCall {
  std::string role, plugin, function;  ///< "contact", "contact 'x' (file)", "solve"
  double seconds = 0;                  ///< since it was first seen
  double counted_seconds = 0;          ///< processor time of its thread, at least a tenth of `seconds`
  /// "plugin contact 'x' (file), solve() has not returned for 12 s".
  std::string text() const;
};

/// Watches the calls of plugins' functions that the constructing thread notes. Another thread asks overdue(). Nothing
/// is asked of the watched one: it may be deaf to all signals.
class CallWatch {
 public:
  explicit CallWatch(const CallNote& note);

  /// The call under way; none between calls.
  std::optional<LongCall> overdue();

 private:
  double processor_seconds() const;

  const CallNote& note_;
  clockid_t clock_{};
  // Of the call that was seen last.
  std::uint64_t serial_ = 0;
  std::chrono::steady_clock::time_point seen_;
  double processor_then_ = 0;
};

}  // namespace ricochet
