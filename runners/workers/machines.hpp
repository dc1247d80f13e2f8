#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runners/workers/worker_messages.hpp"

namespace ricochet {

/// Carries bytes between the processes of a run on several machines, numbered 0 … size − 1 (its ranks). They come
/// whole, and in order between any two of them. A rank may vanish without a word.
class Transport {
 public:
  struct Packet {
    int from = 0;
    std::string bytes;
  };

  virtual ~Transport() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Does not wait for the other side. May be called from any thread.
  virtual void send(int to, std::string bytes) = 0;
  /// The next packet, from whomever; nothing where none came for so long. From one thread.
  virtual std::optional<Packet> receive(double seconds) = 0;
};

// What the coordinator (rank 0) and the agents of the other machines send each other, as bytes of this kind of
// machine.

/// The machine of an agent, told once, before anything else.
struct HostFacts {
  std::string name;
  int rank = 0;
  int processors = 1, online = 1;   ///< that it may keep busy, and that the machine has
  std::string limit;                ///< what allows fewer, "" where nothing does
  double memory = 0;                ///< bytes free; 0: nobody says
  std::string program, arithmetic;  ///< hash and digest
  std::string failure;              ///< why it cannot serve; "" where it can
};

std::string to_bytes(const Message& message);
std::string to_bytes(const HostFacts& facts);
std::string to_bytes(const WorkerEnd& end);
/// Throw std::runtime_error for other bytes. What a Message carries is not looked at.
Message host_message(const std::string& bytes);
HostFacts host_facts(const std::string& bytes);
WorkerEnd worker_end(const std::string& bytes);

/// The coordinator's side of the agents: a WorkerHost for each of the other ranks. A machine is lost, with all its
/// workers, where nothing is heard of it for `silence` seconds, or where it says what is no message. Seconds in which
/// this process was stopped itself do not count. A lost machine is not asked again.
class RemoteHosts {
 public:
  /// Told once of each machine that is lost, and why: "does not answer any more".
  using TellLost = std::function<void(const HostFacts&, const std::string& why)>;
  RemoteHosts(Transport& transport, TellLost lost, double silence = lost_after);
  /// Dismisses the agents.
  ~RemoteHosts();
  RemoteHosts(const RemoteHosts&) = delete;
  RemoteHosts& operator=(const RemoteHosts&) = delete;

  /// The facts of all other ranks, in their order; waits for them. Throws std::runtime_error where one is silent, or
  /// says something else.
  std::vector<HostFacts> facts();
  /// The machine of a rank, with room for so many workers.
  std::shared_ptr<WorkerHost> host(int rank, int width, double memory);
  /// Sends the agents home and waits until they are gone: nobody speaks afterwards to who is not there any more. All
  /// workers of its hosts are gone before. False where a machine is lost.
  bool dismiss();

 private:
  class Host;
  class RemoteWorker;
  /// What is heard of one worker.
  struct Inbox;
  struct Rank {
    std::optional<HostFacts> facts;
    double silent = 0;  ///< s, of the listener's time
    std::atomic<bool> lost{false};
    bool gone = false;  ///< sent home, and it said so
    std::string why;    ///< it is lost
    std::map<std::uint32_t, std::shared_ptr<Inbox>> workers;
  };
  void listen();
  void hear(Transport::Packet packet);
  void hear(Rank& rank, Message said);
  void look_for_lost();
  void lose(Rank& rank, const std::string& why);
  void say_alive();
  void tell(int rank, const Message& message);

  Transport& transport_;
  const TellLost lost_;
  const double silence_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int, Rank> ranks_;
  std::uint32_t born_ = 0;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  std::atomic<bool> leaving_{false}, ending_{false};
  std::thread listener_;
};

/// The life of an agent. It tells the coordinator (rank 0) what its machine is, and starts workers there. It passes on
/// what they and the coordinator say, until the coordinator lets it leave. False where nothing was heard of the
/// coordinator for `silence` seconds. It computes nothing itself: nothing that a plugin does can end it. All workers
/// are gone when it returns.
bool serve_as_agent(Transport& transport, const HostFacts& facts,
                    const std::function<std::unique_ptr<Worker>()>& start_worker, double silence = lost_after);

/// The facts of the machine that this process runs on. What is wrong with it is their `failure`.
HostFacts facts_of_this_machine(int rank);

/// Workers for each machine: those of ranks that share one share its processors.
std::vector<int> workers_of(const std::vector<HostFacts>& machines);

/// Why these machines cannot march one study together, a line for each that cannot; "" where they can. The first one
/// is the coordinator's.
std::string objections(const std::vector<HostFacts>& machines);

/// What is odd, though it works: a line for each rank that is bound to fewer processors than its machine has.
std::string oddities(const std::vector<HostFacts>& machines, const std::vector<int>& workers);

/// "4 workers on 3 machines: a 2, b 1, c 1".
std::string words_of(const std::vector<HostFacts>& machines, const std::vector<int>& workers);

/// The machines of a run, the coordinator's first. `jobs`: workers of each; 0: what workers_of() says.
std::vector<std::shared_ptr<WorkerHost>> hosts_of(RemoteHosts& remote, const std::vector<HostFacts>& machines,
                                                  int jobs);

}  // namespace ricochet
