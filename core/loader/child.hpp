#pragma once
#include <cstdint>
#include <functional>
#include <ricochet/contract/plugin_call.hpp>
#include <string>

namespace ricochet {

/// How work in a child process ended, and what it left.
struct ChildOutcome {
  enum class End { value, exception, signal, exit, timeout, memory };
  End end = End::value;
  std::string text;  ///< what the work returned, or what its exception says
  int number = 0;    ///< the signal, or the exit code
  double limit = 0;  ///< s, or bytes, that it did not keep
  SeenCall call;     ///< of a plugin, under way or the last one before: where none of its own words came back
  /// How `afterwards` ended, "ended by signal 11 (segmentation fault)"; "" where it came back.
  std::string afterwards;

  bool ok() const { return end == End::value; }
  /// "ended by signal 11 (segmentation fault)", "ended the process with exit code 7", "did not end within 10 s", "took
  /// more than the 2 GiB of memory that it may take", or the text of the exception.
  std::string cause() const;
  /// The cause, with plugin, file and function before it where they are known: "plugin time 'x' (x.so), plan(): ended
  /// …".
  std::string sentence() const;
};

/// What a child process does, and what it may take.
struct ChildWork {
  std::function<std::string()> work;
  double seconds;  ///< of wall time; infinite: no limit
  /// Bytes of address space beside what this process has; 0: no limit.
  double memory = double{1U << 30U} * 4;
  /// Done once the value is on its way, then static destructors; none: nothing of the kind runs.
  std::function<void()> afterwards = {};
  /// Called in this process, once, where the work lasts longer than some seconds.
  std::function<void()> waits = {};
};

/// Runs `work` in a child process and waits for it. Whatever a plugin does there (abort, exit, write where it must not,
/// never return, fork, block every signal), this process stays as it was. The child has no descriptor of this process
/// but for stderr, which takes all that it prints. It leaves no core file, and no process of its own group. Code of
/// libraries that are not the program's own may run in it (ForeignCode). Throws std::system_error when no process can
/// be had.
ChildOutcome run_in_child(const ChildWork& work);
ChildOutcome run_in_child(const std::function<std::string()>& work, double seconds,
                          const std::function<void()>& waits = {});

/// Where code of third-party libraries may run. A process is free to run it, until it says that only its children do.
class ForeignCode {
 public:
  /// While it lives, this process runs none.
  class InChildrenAlone {
   public:
    InChildrenAlone();
    ~InChildrenAlone();
    InChildrenAlone(const InChildrenAlone&) = delete;
    InChildrenAlone& operator=(const InChildrenAlone&) = delete;
  };
  static bool may_run();
  /// From here on this process runs it.
  static void allow();
};

/// Lets this process take so many bytes of address space, or fewer where it may have no more; 0: as it is. What it may
/// take. With a sanitizer, which takes far more of it than it uses, nothing is limited.
std::uint64_t limit_address_space(double bytes);

/// The file of a descriptor under another number, at least `least`; the descriptor is closed. -1 with errno where no
/// number is free. Both close on exec.
int duplicated_from(int least, int descriptor);

/// "signal 11 (segmentation fault)".
std::string signal_in_words(int signal);
/// "2 GiB", "117 MiB".
std::string bytes_in_words(double bytes);

}  // namespace ricochet
