#include <catch2/catch.hpp>
#include <thread>
#include <utility>

#include "runners/march/study_identity.hpp"
#include "runners/workers/isolated_cases.hpp"
#include "runners/workers/machines.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/workers/agents_play.hpp"
#include "tests/runners/workers/scripted_network.hpp"

namespace agents_tests {

TEST_CASE("agents: the same rows in thousands of orders of what is said, workers ending here and there") {
  constexpr std::uint32_t orders = 2000;
  for (std::uint32_t seed = 0; seed < orders; ++seed) {
    CAPTURE(seed);
    const Study study = study_of(seed);
    const std::size_t ranks = seed / 2 % 4;
    StoredRows kept;
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
    StoredRows kept;
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
    StoredRows kept;
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
    StoredRows kept;
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
    StoredRows kept;
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

}  // namespace agents_tests
