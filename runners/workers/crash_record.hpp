#pragma once
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace ricochet {

/// What a process left behind that was ended from within: by a signal, or by exit() called by a plugin.
struct CrashRecord {
  std::string plugin, function;  ///< "contact 'x' (file)", "solve"; "" outside of any plugin's function
  std::string ended;             ///< "signal 11 (segmentation fault)", "a call of exit()"
};

/// What such a record says; nothing where it is not whole.
std::optional<CrashRecord> parse_crash_record(const std::string& text);

/// While it lives, a process that ends by a crash leaves a crash record in `file`. Crashes are SIGSEGV, SIGBUS, SIGFPE,
/// SIGILL and SIGABRT, and exit() or quick_exit() called by a plugin. Signals then end the process as they would have;
/// exit() becomes code 3. One at a time per process.
class CrashGuard {
 public:
  explicit CrashGuard(const std::filesystem::path& file);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;
};

/// A call of a plugin's function that has not returned yet.
struct LongCall {
  std::string role, plugin, function;  ///< "contact", "contact 'x' (file)", "solve"
  double seconds = 0;                  ///< since it was first seen
  double counted_seconds = 0;          ///< processor time of its thread, at least a tenth of `seconds`
  /// "plugin contact 'x' (file), solve() has not returned for 12 s".
  std::string text() const;
};

/// Watches the calls of plugins' functions that the constructing thread makes; one per process. Another thread asks
/// overdue(). The watched one answers in a signal handler (SIGURG).
class CallWatch {
 public:
  CallWatch();
  ~CallWatch();
  CallWatch(const CallWatch&) = delete;
  CallWatch& operator=(const CallWatch&) = delete;

  /// The call under way; none between calls. What the thread said last stands until it answers again.
  std::optional<LongCall> overdue();

 private:
  struct Answer;
  static void on_question(int);
  bool answered() const;
  void note_answer();

  static inline std::atomic<Answer*> asked_{nullptr};
  const std::unique_ptr<Answer> answer_;
  const pthread_t thread_;
  // Of the call that the last answer named; serial 0: none.
  unsigned long long serial_ = 0;
  LongCall call_;
  std::chrono::steady_clock::time_point seen_;
  double processor_ = 0, processor_then_ = 0;  // of the thread, at the last answer and when the call was first seen
};

/// Room for this thread's signal handlers where its own stack has run out.
class HandlerStack {
 public:
  HandlerStack();
  ~HandlerStack();
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  std::unique_ptr<char[]> memory_;
};

}  // namespace ricochet
