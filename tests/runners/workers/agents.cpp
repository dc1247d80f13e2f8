/// The coordinator against machines that are scripts: whatever the order in which they speak, and whichever of them
/// vanish, come back late or talk nonsense, the same rows come out, each once, and nobody waits for ever.
#include <catch2/catch.hpp>
#include <cmath>
#include <thread>
#include <utility>

#include "runners/march/study_identity.hpp"
#include "runners/workers/isolated_cases.hpp"
#include "runners/workers/machines.hpp"
#include "runners/workers/remote_hosts.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/workers/scripted_network.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace agents_tests {
namespace {

using Fate = ScriptedNetwork::Fate;

/// This machine, without processes.
class ScriptedHost : public WorkerHost {
 public:
  ScriptedHost(ScriptedWorld& world, int width) : world_(world), width_(width) {}
  std::string name() const override { return "here"; }
  int width() const override { return width_; }
  double memory() const override { return 0; }
  bool there() const override { return true; }
  std::unique_ptr<Worker> start() override { return std::make_unique<ScriptedWorker>(world_); }

 private:
  ScriptedWorld& world_;
  const int width_;
};

/// What a store keeps, and how often it was told each row.
struct Kept {
  std::mutex mutex;
  std::map<std::string, std::string> checkpoints, rows;
  std::map<std::string, int> told;

  CheckpointStore store_of() {
    CheckpointStore all;
    all.find = [this](const std::string& key) {
      const std::lock_guard guard(mutex);
      return checkpoints[key];
    };
    all.keep = [this](const std::string& key, const std::string& content) {
      const std::lock_guard guard(mutex);
      checkpoints[key] = content;
    };
    all.show = [](const CaseRecord&) {};
    all.failed = [](const std::string&) { return false; };
    return all;
  }
};

/// A study whose cases march anywhere, or one whose cases stay beside the store and have blocks marched anywhere.
Study study_of(std::uint32_t seed, int cases = 5) {
  Study study = fake_study(cases);
  if (seed % 2 == 0) study.kind = "bifurcation";
  return study;
}

std::map<std::string, std::string> expected_rows(const Study& study) {
  std::map<std::string, std::string> rows;
  for (const StudyCase& one : study.cases) {
    CaseRecord row = scripted_row(one.id);
    row.id = one.id;
    row.axes = one.axes;
    rows[one.id] = to_bytes(row);
  }
  return rows;
}

/// Runs what is missing of the study on these machines, `stop` being raised by whoever likes.
void run_missing(const Study& study, std::vector<std::shared_ptr<WorkerHost>> hosts, Kept& kept,
                 std::atomic<bool>& stop) {
  const Registry registry;
  const RunContext context{study, registry, [](const StudyCase& one) { return one.id; }};
  IsolatedCases isolated(context, {1, {}, std::move(hosts)});
  StudyRunner runner;
  runner.cases = isolated.runner();
  try {
    runner.cases.open(kept.store_of(), stop);
  } catch (const Interrupted&) {
    return;
  }
  std::vector<PendingCase> pending;
  for (const StudyCase& one : study.cases) {
    if (kept.rows.count(one.id)) continue;
    isolated.predicted_seconds(one);
    pending.push_back({&one, 1, one.id});
  }
  CaseEvents events;
  events.begins = [](const PendingCase&) {};
  events.finished = [&](const CaseRecord& record, const PendingCase*) {
    const std::lock_guard guard(kept.mutex);
    kept.rows[record.id] = to_bytes(record);
    ++kept.told[record.id];
  };
  run_cases(runner, std::move(pending), isolated.cases_at_once(), stop, events);
}

ScriptedWorld& prepare(ScriptedWorld& world, const Study& study, std::uint32_t seed, double crashes) {
  static const Registry registry;
  static std::map<std::pair<std::string, std::size_t>, std::string> identities;
  std::string& identity = identities[{study.kind, study.cases.size()}];
  if (identity.empty()) identity = StudyIdentity(study, registry).of_all();
  world.identity = identity;
  world.arithmetic = arithmetic_digest();
  world.luck.seed(seed);
  world.crashes = crashes;
  return world;
}

struct Outcome {
  int lost = 0;  ///< machines that were given up, each told once
  ScriptedNetwork::Left left;
};

/// A run on this machine and on one for each of the fates.
Outcome run_scripts(const Study& study, std::uint32_t seed, const std::vector<Fate>& fates, Kept& kept,
                    std::atomic<bool>& stop, double silence, double crashes) {
  ScriptedWorld world;
  prepare(world, study, seed, crashes);
  constexpr double alive_in_silence = 5;
  ScriptedNetwork network(world, seed, fates, silence / alive_in_silence);
  Outcome outcome;
  std::atomic<int> lost{0};
  {
    RemoteHosts remote(
        network, [&](const HostFacts&, const std::string&) { ++lost; }, silence);
    std::vector<std::shared_ptr<WorkerHost>> hosts = {std::make_shared<ScriptedHost>(world, 1)};
    for (const HostFacts& one : remote.facts()) hosts.push_back(remote.host(one.rank, 1 + one.rank % 2, 0));
    run_missing(study, hosts, kept, stop);
  }
  outcome.lost = lost;
  outcome.left = network.left();
  return outcome;
}

void check_all(const Study& study, const Kept& kept) {
  CHECK((kept.rows == expected_rows(study)));
  for (const auto& [id, times] : kept.told) CHECK(times == 1);
}

constexpr double long_silence = 60;      // s
constexpr double none = 0, some = 0.15;  // share of units whose first attempt ends its worker

}  // namespace

TEST_CASE("agents: the same rows in thousands of orders of what is said, workers ending here and there") {
  constexpr std::uint32_t orders = 2000;
  for (std::uint32_t seed = 0; seed < orders; ++seed) {
    CAPTURE(seed);
    const Study study = study_of(seed);
    const std::size_t ranks = seed / 2 % 4;
    Kept kept;
    std::atomic<bool> stop{false};
    const Outcome outcome = run_scripts(study, seed, std::vector<Fate>(ranks), kept, stop, long_silence, some);
    check_all(study, kept);
    CHECK(outcome.lost == 0);
    // All are sent home, and no worker is left behind.
    CHECK(outcome.left.home == static_cast<int>(ranks));
    CHECK(outcome.left.workers == 0);
  }
}

TEST_CASE("agents: machines that vanish cost time, what those say that come back late counts for nothing") {
  constexpr double silence = 0.04;
  constexpr std::uint32_t orders = 300;
  int lost = 0;
  for (std::uint32_t seed = 0; seed < orders; ++seed) {
    CAPTURE(seed);
    const Study study = study_of(seed);
    std::mt19937 luck(seed);
    std::vector<Fate> fates(1 + luck() % 3);
    for (Fate& fate : fates) {
      fate.what = std::array{Fate::What::stays, Fate::What::vanishes, Fate::What::comes_back}[luck() % 3];
      fate.after = 1 + static_cast<int>(luck() % 30);
      fate.absence = silence * (0.5 + 0.1 * static_cast<double>(luck() % 20));
    }
    Kept kept;
    std::atomic<bool> stop{false};
    lost += run_scripts(study, seed, fates, kept, stop, silence, some).lost;
    check_all(study, kept);
  }
  CHECK(lost > static_cast<int>(orders) / 4);
}

TEST_CASE("agents: a coordinator that was stopped for a while takes nobody for lost") {
  const Study study = study_of(1);
  constexpr double silence = 0.5;
  constexpr std::uint32_t orders = 10;
  for (std::uint32_t seed = 0; seed < orders; ++seed) {
    CAPTURE(seed);
    ScriptedWorld world;
    prepare(world, study, seed, none);
    ScriptedNetwork network(world, seed, std::vector<Fate>(3), silence / 10);
    network.stop_rank_0(static_cast<int>(10 + seed), 2 * silence);
    Kept kept;
    std::atomic<bool> stop{false};
    std::atomic<int> lost{0};
    RemoteHosts remote(
        network, [&](const HostFacts&, const std::string&) { ++lost; }, silence);
    std::vector<std::shared_ptr<WorkerHost>> hosts = {std::make_shared<ScriptedHost>(world, 1)};
    for (const HostFacts& one : remote.facts()) hosts.push_back(remote.host(one.rank, 1, 0));
    run_missing(study, hosts, kept, stop);
    check_all(study, kept);
    CHECK(lost == 0);
  }
}

TEST_CASE("agents: one whose messages are cut or nonsense costs at most its machine") {
  constexpr std::uint32_t orders = 600;
  int lost = 0;
  for (std::uint32_t seed = 0; seed < orders; ++seed) {
    CAPTURE(seed);
    const Study study = study_of(seed);
    std::mt19937 luck(seed);
    std::vector<Fate> fates(1 + luck() % 3);
    for (Fate& fate : fates) {
      fate.what = std::array{Fate::What::stays, Fate::What::cut, Fate::What::nonsense}[luck() % 3];
      fate.after = 1 + static_cast<int>(luck() % 30);
    }
    // A worker whose message was cut has ended, and what ends two of them is failed: one machine cuts, others babble.
    bool cut = false;
    for (Fate& fate : fates)
      if (fate.what == Fate::What::cut && std::exchange(cut, true)) fate.what = Fate::What::nonsense;
    Kept kept;
    std::atomic<bool> stop{false};
    lost += run_scripts(study, seed, fates, kept, stop, long_silence, none).lost;
    check_all(study, kept);
  }
  CHECK(lost > static_cast<int>(orders) / 4);
}

TEST_CASE("agents: a run that is stopped ends, keeps what was finished, and goes on to the same rows") {
  constexpr std::uint32_t orders = 300;
  int stopped_early = 0;
  for (std::uint32_t seed = 0; seed < orders; ++seed) {
    CAPTURE(seed);
    const Study study = study_of(seed);
    Kept kept;
    std::atomic<bool> stop{false};
    std::thread somebody([&stop, wait = seed % 30] {
      std::this_thread::sleep_for(std::chrono::microseconds(100 * wait));
      stop = true;
    });
    const Outcome outcome = run_scripts(study, seed, std::vector<Fate>(2), kept, stop, long_silence, some);
    somebody.join();
    CHECK(outcome.left.workers == 0);
    if (kept.rows.size() < study.cases.size()) ++stopped_early;
    stop = false;
    run_scripts(study, seed + 1, std::vector<Fate>(1), kept, stop, long_silence, some);
    check_all(study, kept);
  }
  CHECK(stopped_early > 0);
}

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
    Kept kept;
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
