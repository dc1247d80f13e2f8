#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runners/workers/machines.hpp"
#include "tests/runners/workers/scripted_worker.hpp"

namespace ricochet::tests {

/// A network with agents that are scripts, as rank 0 sees it. It hears whole packets, in order from any one rank,
/// otherwise in an order that luck decides. Each rank has a pace of its own. An agent does its work while rank 0
/// listens.
class ScriptedNetwork : public Transport {
 public:
  /// What becomes of an agent.
  struct Fate {
    enum class What { stays, vanishes, comes_back, cut, nonsense } what = What::stays;
    int after = 0;         ///< packets that it hears before
    double absence = 0.1;  ///< s, of one that comes back
  };

  /// A rank for each of the fates. `alive_every`: s.
  ScriptedNetwork(ScriptedWorld& world, std::uint32_t seed, std::vector<Fate> fates, double alive_every);

  /// Rank 0 hears nothing for so many s, once, after so many packets, as if it had been stopped; the others go on.
  void stop_rank_0(int after, double seconds) {
    stop_after_ = after;
    stop_seconds_ = seconds;
  }

  int rank() const override { return 0; }
  int size() const override { return static_cast<int>(agents_.size()) + 1; }
  void send(int to, std::string bytes) override;
  std::optional<Packet> receive(double seconds) override;

  /// Once rank 0 has gone: agents hear what was sent to them. The workers that agents have then, and the agents that
  /// were sent home.
  struct Left {
    int workers = 0, home = 0;
  };
  Left left();

 private:
  using Clock = std::chrono::steady_clock;
  struct Agent {
    Fate fate;
    int pace = 1, heard = 0;
    bool dark = false, home = false;
    Clock::time_point since, spoke;  ///< when it went dark; when it last said that it is there
    std::deque<std::string> to_it, from_it;
    std::map<std::uint32_t, std::unique_ptr<ScriptedWorker>> workers;
  };
  void hear(Agent& agent, const std::string& bytes);
  void pass_on(Agent& agent, std::uint32_t number, ScriptedWorker& worker);
  void meet_fate(Agent& agent);
  void look_at_the_clock();

  ScriptedWorld& world_;
  const double alive_every_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::mt19937 luck_;
  int stop_after_ = -1;
  double stop_seconds_ = 0;
  std::deque<Agent> agents_;  // of rank 1, 2, …
};

}  // namespace ricochet::tests
