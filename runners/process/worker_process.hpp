#pragma once
#include <sys/types.h>

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "runners/process/channel.hpp"

namespace ricochet {

/// How a worker ended.
struct WorkerEnd {
  std::string cause;             ///< "signal 11 (segmentation fault)", "exit code 7"
  std::string plugin, function;  ///< whose function it was in, where it could say so: "contact 'x' (file)", "solve"
  std::string last_lines;        ///< of its stderr, "|" between two
  bool silent = false;           ///< it said nothing for too long, and was killed for that

  /// "plugin contact 'x' (x.so), solve(): its process was ended by signal 11 (segmentation fault); it wrote: …".
  /// `times`: put behind the verb, "twice".
  std::string sentence(const std::string& times = "") const;
};

/// `ricochet worker` as a child of this process: the same program, with a channel to it. What it writes to stderr goes
/// on to this process's, and its end is kept.
class WorkerProcess {
 public:
  /// Throws std::runtime_error where no process can be had.
  WorkerProcess();
  /// Ends it.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  Channel& channel() { return *channel_; }
  pid_t pid() const { return pid_; }
  void kill();
  /// Waits until it has ended. Once.
  WorkerEnd end();

 private:
  void pass_on_stderr(int descriptor);

  pid_t pid_ = -1;
  std::unique_ptr<Channel> channel_;
  int crash_record_ = -1;  // a file without a name, which the worker writes when it crashes
  std::thread listener_;
  std::mutex mutex_;
  std::string last_lines_;
  bool ended_ = false;
};

/// Descriptors that a worker is born with.
inline constexpr int kWorkerChannel = 3, kWorkerCrashRecord = 4;

}  // namespace ricochet
