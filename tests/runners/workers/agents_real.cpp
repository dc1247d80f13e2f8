#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "runners/march/study_identity.hpp"
#include "runners/workers/isolated_cases.hpp"
#include "runners/workers/machines.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/workers/agents_play.hpp"
#include "tests/runners/workers/scripted_network.hpp"

namespace agents_tests {

namespace {

/// Ranks of this process, each with a thread of its own.
class Exchange {
 public:
  explicit Exchange(int ranks) : boxes_(static_cast<std::size_t>(ranks)) {}

  class End : public Transport {
   public:
    End(Exchange& all, int rank) : all_(all), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(all_.boxes_.size()); }
    void send(int to, std::string bytes) override { all_.put(to, {rank_, std::move(bytes)}); }
    std::optional<Packet> receive(double seconds) override { return all_.take(rank_, seconds); }

   private:
    Exchange& all_;
    const int rank_;
  };

  /// Packets to a rank that it has not taken.
  std::size_t unheard(int rank) {
    const std::lock_guard guard(mutex_);
    return boxes_.at(static_cast<std::size_t>(rank)).size();
  }

 private:
  void put(int to, Transport::Packet packet) {
    const std::lock_guard guard(mutex_);
    boxes_.at(static_cast<std::size_t>(to)).push_back(std::move(packet));
    changed_.notify_all();
  }
  std::optional<Transport::Packet> take(int rank, double seconds) {
    auto& box = boxes_.at(static_cast<std::size_t>(rank));
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !box.empty(); }))
      return std::nullopt;
    Transport::Packet packet = std::move(box.front());
    box.pop_front();
    return packet;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::deque<Transport::Packet>> boxes_;
};

/// Counts those that are there.
class CountedWorker : public ScriptedWorker {
 public:
  CountedWorker(ScriptedWorld& world, std::atomic<int>& there) : ScriptedWorker(world), there_(there) { ++there_; }
  ~CountedWorker() override { --there_; }

 private:
  std::atomic<int>& there_;
};

}  // namespace

TEST_CASE("agents: the real ones pass on what workers say and how they end, and leave none when they are sent home") {
  constexpr std::uint32_t times = 20;
  constexpr int ranks = 4;
  for (std::uint32_t seed = 0; seed < times; ++seed) {
    CAPTURE(seed);
    const Study study = study_of(seed, 7);
    ScriptedWorld world;
    prepare(world, study, seed, 0.2);
    Exchange exchange(ranks);
    std::atomic<int> there{0}, served{0};  // what threads find is checked once they have ended
    std::vector<std::thread> agents;
    for (int rank = 1; rank < ranks; ++rank)
      agents.emplace_back([&, rank] {
        Exchange::End end(exchange, rank);
        HostFacts facts;
        facts.rank = rank;
        facts.name = "machine " + std::to_string(rank);
        served +=
            static_cast<int>(serve_as_agent(end, facts, [&] { return std::make_unique<CountedWorker>(world, there); }));
      });
    StoredRows kept;
    {
      Exchange::End end(exchange, 0);
      RemoteHosts remote(end, [](const HostFacts&, const std::string&) { FAIL_CHECK("a machine is lost"); });
      std::vector<std::shared_ptr<WorkerHost>> hosts = {std::make_shared<ScriptedHost>(world, 1)};
      for (const HostFacts& one : remote.facts()) hosts.push_back(remote.host(one.rank, 2, 0));
      std::atomic<bool> stop{false};
      run_missing(study, hosts, kept, stop);
      check_all(study, kept);
    }
    for (std::thread& one : agents) one.join();
    // Whoever went had heard all that is ever said to it: nothing waits for one who is not there any more.
    for (int rank = 0; rank < ranks; ++rank) CHECK(exchange.unheard(rank) == 0);
    CHECK(served == ranks - 1);
    CHECK(there == 0);
  }
}

TEST_CASE("agents: no block of a case is marched any more once the case is let go") {
  constexpr int owner = 7;
  std::atomic<bool> begun{false}, came_back{false};
  BlockPool pool(2, [&](const BlockPool::Block& block, const std::function<bool()>& stopping) {
    if (block.owner != owner) return;
    begun = true;
    while (!stopping()) std::this_thread::yield();
    // A while in which who does not wait would be seen.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    came_back = true;
  });
  pool.begin({{}, owner, 1, [](BlockStatus) {}});
  pool.begin({{}, owner + 1, 1, [](BlockStatus) {}});
  while (!begun) std::this_thread::yield();
  pool.forget(owner);
  CHECK(came_back);
}

TEST_CASE("agents: a machine whose workers cannot be started says why") {
  const Study study = study_of(0, 2);
  ScriptedWorld world;
  prepare(world, study, 1, 0);
  Exchange exchange(2);
  std::thread agent([&] {
    Exchange::End end(exchange, 1);
    HostFacts facts;
    facts.rank = 1;
    facts.name = "far";
    serve_as_agent(end, facts, []() -> std::unique_ptr<Worker> { throw std::runtime_error("no process to be had"); });
  });
  {
    Exchange::End end(exchange, 0);
    RemoteHosts remote(end, [](const HostFacts&, const std::string&) { FAIL_CHECK("a machine is lost"); });
    remote.facts();
    const auto worker = remote.host(1, 1, 0)->start();
    Message message;
    CHECK(worker->receive(message, long_silence) == Channel::Heard::gone);
    CHECK(worker->end().cause == "no process to be had");
    CHECK_FALSE(worker->send({Message::Word::stop}));
  }
  agent.join();
}

TEST_CASE("agents: one whose coordinator falls silent leaves, with its workers") {
  const Study study = study_of(0, 2);
  ScriptedWorld world;
  prepare(world, study, 1, 0);
  Exchange exchange(2);
  std::atomic<int> there{0};
  Exchange::End(exchange, 0).send(1, to_bytes(Message{.word = Message::Word::start, .worker = 1}));
  Exchange::End end(exchange, 1);
  HostFacts facts;
  facts.rank = 1;
  CHECK_FALSE(serve_as_agent(
      end, facts, [&] { return std::make_unique<CountedWorker>(world, there); }, 0.1));
  CHECK(there == 0);
}

TEST_CASE("agents: one that talks nonsense before its facts is named with its rank") {
  Exchange exchange(3);
  Exchange::End end(exchange, 0);
  Exchange::End other(exchange, 2);
  HostFacts facts;
  facts.rank = 2;
  Exchange::End(exchange, 1).send(0, "host 0: an older build says hello");
  other.send(0, to_bytes(Message{.word = Message::Word::facts, .content = to_bytes(facts)}));
  RemoteHosts remote(
      end, [](const HostFacts&, const std::string&) {}, 0.2);
  CHECK_THROWS_WITH(remote.facts(), Catch::Contains("rank 1") && Catch::Contains("another build"));
  CHECK_FALSE(remote.dismiss());
}

}  // namespace agents_tests
