#pragma once
#include <signal.h>
#include <sys/types.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runners/workers/call_watch.hpp"
#include "runners/workers/worker_messages.hpp"

namespace ricochet {

/// The program that workers are: this one, found even where its file was replaced meanwhile; never one that is an MPI
/// rank.
const std::string& worker_program();

/// The environment variables of a worker, "NAME=value". They are those of this process without what a parallel launcher
/// put there for its own ranks. The BLAS gets one thread where nothing else is said.
std::vector<std::string> worker_environment();

/// Signals that are for the coordinator, which tells its workers: schedulers send them to every process of a job. A
/// worker is born with them held back, and ignores them from its first line on.
inline constexpr std::array<int, 4> signals_of_coordinator = {SIGINT, SIGTERM, SIGUSR1, SIGHUP};
/// These, as a set.
sigset_t coordinator_signals();

/// Descriptors that a worker is born with.
inline constexpr int kWorkerChannel = 3, kWorkerNote = 4;

/// `ricochet worker` as a child of this process: the same program, with a channel to it. What it writes to stderr goes
/// on to this process's, and its end is kept.
class WorkerProcess : public Worker {
 public:
  /// Throws RunError where no process can be had.
  WorkerProcess();
  /// Ends it.
  ~WorkerProcess() override;
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  bool send(const Message& message) override { return channel_->send(message); }
  /// Gone where its process has ended: others that it began may hold its end of the channel.
  Channel::Heard receive(Message& message, double seconds) override;
  void kill() override;
  bool stopped() override;
  WorkerEnd end() override;

 private:
  void pass_on_stderr(int descriptor);
  bool has_ended() const;

  pid_t pid_ = -1;
  std::unique_ptr<Channel> channel_;
  const NoteFile note_{kWorkerNote + 1};
  std::thread listener_;
  std::mutex mutex_;
  std::string last_lines_;
  std::atomic<bool> ended_ = false;
  std::atomic<bool> killed_stopped_ = false;
};

/// The name of this machine, "?" where it has none.
std::string machine_name();

/// Bytes that its processes may still take; 0 where nobody says.
double free_memory();

/// Bytes of address space for each of so many workers where `free` bytes are free: an equal share, at least 2 GiB. 0
/// (no limit) where it is not known.
double memory_for_each(double free, int workers);

/// This machine.
class LocalHost : public WorkerHost {
 public:
  /// `memory`: bytes of address space for each worker.
  LocalHost(int width, double memory) : width_(width), memory_(memory) {}
  explicit LocalHost(int width) : LocalHost(width, memory_for_each(free_memory(), width)) {}

  std::string name() const override { return machine_name(); }
  int width() const override { return width_; }
  double memory() const override { return memory_; }
  bool there() const override { return true; }
  std::unique_ptr<Worker> start() override { return std::make_unique<WorkerProcess>(); }

 private:
  const int width_;
  const double memory_;
};

/// The life of a worker. It opens the study that it is sent. Then it does what it is asked to, case by case, until the
/// other end of its channel closes. What cases keep and look for is the coordinator's. Returns its exit code; ends the
/// process itself where a plugin's function does not come back.
int serve_as_worker();

}  // namespace ricochet
