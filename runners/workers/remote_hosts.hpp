#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runners/workers/host_messages.hpp"

namespace ricochet {

/// The coordinator's side of the agents: a WorkerHost for each of the other ranks. A machine of which nothing is heard
/// for `silence` seconds, those not counted in which this process was stopped itself, or which says what is no message,
/// is lost, with all its workers, and is not asked again.
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

}  // namespace ricochet
