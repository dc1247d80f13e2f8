#pragma once
#include <filesystem>
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

/// While it lives, the process does not end without a name: a signal of the processor (SIGSEGV, SIGBUS, SIGFPE, SIGILL)
/// or SIGABRT, and exit() or quick_exit() called by a plugin, leave a crash record in `file`. Signals then end the
/// process as they would have; exit() becomes code 3. One at a time per process.
class CrashGuard {
 public:
  explicit CrashGuard(const std::filesystem::path& file);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;
};

}  // namespace ricochet
