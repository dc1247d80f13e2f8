#include "runners/workers/agent.hpp"

#include <atomic>
#include <chrono>
#include <map>
#include <thread>

namespace ricochet {
namespace {

using What = HostMessage::What;

constexpr int coordinator = 0;

/// A worker of this machine, and the thread that listens to it.
class AgentWorker {
 public:
  AgentWorker(Transport& transport, std::uint32_t number, const std::function<std::unique_ptr<Worker>()>& start)
      : transport_(transport), number_(number) {
    try {
      worker_ = start();
    } catch (const std::exception& error) {
      tell_end({.cause = error.what()});
      return;
    }
    listener_ = std::thread([this] { listen(); });
  }
  ~AgentWorker() {
    if (worker_) worker_->kill();
    if (listener_.joinable()) listener_.join();
  }
  AgentWorker(const AgentWorker&) = delete;
  AgentWorker& operator=(const AgentWorker&) = delete;

  void send(const Message& message) {
    if (worker_) worker_->send(message);
  }
  void kill() {
    if (worker_) worker_->kill();
  }
  bool ended() const { return ended_; }

 private:
  void listen() {
    constexpr double long_time = 1e6;
    Message message;
    for (;;) {
      const Channel::Heard heard = worker_->receive(message, long_time);
      if (heard == Channel::Heard::gone) break;
      if (heard == Channel::Heard::message)
        transport_.send(coordinator, to_bytes(HostMessage{What::message, number_, std::move(message)}));
    }
    tell_end(worker_->end());
  }
  void tell_end(const WorkerEnd& end) {
    transport_.send(coordinator, to_bytes(HostMessage{What::ended, number_, {.content = to_bytes(end)}}));
    ended_ = true;
  }

  Transport& transport_;
  const std::uint32_t number_;
  std::unique_ptr<Worker> worker_;
  std::thread listener_;
  std::atomic<bool> ended_{false};
};

}  // namespace

bool serve_as_agent(Transport& transport, const HostFacts& facts,
                    const std::function<std::unique_ptr<Worker>()>& start_worker, double silence) {
  transport.send(coordinator, to_bytes(HostMessage{What::facts, 0, {.content = to_bytes(facts)}}));
  std::map<std::uint32_t, std::unique_ptr<AgentWorker>> workers;
  auto told = std::chrono::steady_clock::now(), heard = told;
  for (;;) {
    const auto packet = transport.receive(alive_every / 4);
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - told).count() > alive_every) {
      told = now;
      transport.send(coordinator, to_bytes(HostMessage{What::alive}));
      std::erase_if(workers, [](const auto& one) { return one.second->ended(); });
    }
    if (packet) heard = now;
    if (std::chrono::duration<double>(now - heard).count() > silence) return false;
    if (!packet) continue;
    const HostMessage said = host_message(packet->bytes);
    if (said.what == What::leave) {
      workers.clear();
      transport.send(coordinator, to_bytes(HostMessage{What::gone}));
      return true;
    }
    if (said.what == What::start)
      workers[said.worker] = std::make_unique<AgentWorker>(transport, said.worker, start_worker);
    const auto found = workers.find(said.worker);
    if (found == workers.end()) continue;
    if (said.what == What::message) found->second->send(said.message);
    if (said.what == What::kill) found->second->kill();
  }
}

}  // namespace ricochet
