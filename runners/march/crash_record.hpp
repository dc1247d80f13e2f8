#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace ricochet {

/// What a run left behind that was ended from within: a signal, or exit() called by a plugin.
struct CrashRecord {
  std::string case_id, fingerprint;  ///< "" outside of any case
  std::string plugin, function;      ///< "contact 'x' (file)", "solve"; "" outside of any plugin's function
  std::string ended;                 ///< "signal 11 (segmentation fault)", "a call of exit()"

  /// "plugin contact 'x' (file) ended the program by signal 11 (segmentation fault) in solve() (an earlier run)".
  std::string reason() const;
};

/// What such a record says; nothing where it is not whole.
std::optional<CrashRecord> parse_crash_record(const std::string& text);
/// FOLDER/crash.txt, or nothing when the last run ended otherwise, or was killed.
std::optional<CrashRecord> read_crash_record(const std::filesystem::path& folder);
std::filesystem::path crash_record_file(const std::filesystem::path& folder);
void remove_crash_record(const std::filesystem::path& folder);

/// While it lives, the program does not end without a name: a signal of the processor (SIGSEGV, SIGBUS, SIGFPE, SIGILL)
/// or SIGABRT, and exit() or quick_exit() called by a plugin, say on stderr in whose function and in which case it
/// happened, and leave a crash record in `folder`. Signals then end the program as they would have; exit() becomes code
/// 3. One at a time per process.
class CrashGuard {
 public:
  explicit CrashGuard(const std::filesystem::path& folder);
  /// The same without a word on stderr, where another process reads the record. `file`: of the record.
  static std::unique_ptr<CrashGuard> quiet(const std::filesystem::path& file);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  CrashGuard(const std::filesystem::path& file, bool speaks);
};

}  // namespace ricochet
