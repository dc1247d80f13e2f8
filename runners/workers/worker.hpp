#pragma once
#include <memory>
#include <string>

#include "runners/workers/worker_messages.hpp"

namespace ricochet {

/// How a worker ended.
struct WorkerEnd {
  std::string cause = {};  ///< "signal 11 (segmentation fault)", "exit code 7"
  std::string plugin = {},
              function = {};    ///< whose function it was in, where it could say so: "contact 'x' (file)", "solve"
  std::string last_lines = {};  ///< of its stderr, "|" between two
  bool silent = false;          ///< it said nothing for too long, and was killed for that
  bool host_lost = false;       ///< the machine it was on is gone: no fault of its own

  /// "plugin contact 'x' (x.so), solve(): its process was ended by signal 11 (segmentation fault); it wrote: …".
  /// `times`: put behind the verb, "twice".
  std::string sentence(const std::string& times = "") const;
};

/// A process that marches, here or on another machine. One thread talks to it; kill() may come from another one.
class Worker {
 public:
  virtual ~Worker() = default;
  /// False where it is gone.
  virtual bool send(const Message& message) = 0;
  /// Its next message.
  virtual Channel::Heard receive(Message& message, double seconds) = 0;
  virtual void kill() = 0;
  /// Waits until it has ended. Once.
  virtual WorkerEnd end() = 0;
};

/// A machine on which workers can be started. May be used from any thread.
class WorkerHost {
 public:
  virtual ~WorkerHost() = default;
  virtual std::string name() const = 0;
  /// Workers that it may keep busy at one time.
  virtual int width() const = 0;
  /// Bytes of address space for each of them; 0: no limit.
  virtual double memory() const = 0;
  /// Whether workers can still be started there.
  virtual bool there() const = 0;
  /// Throws std::runtime_error where no process can be had.
  virtual std::unique_ptr<Worker> start() = 0;
};

}  // namespace ricochet
