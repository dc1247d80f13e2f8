#pragma once

/// The coordinator against machines that are scripts. They speak in any order, and some of them vanish, come back late
/// or talk nonsense. The same rows come out, each once, and nobody waits for ever.
#include <catch2/catch.hpp>
#include <utility>

#include "runners/march/study_identity.hpp"
#include "runners/workers/isolated_cases.hpp"
#include "runners/workers/machines.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/workers/scripted_network.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace agents_tests {

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
struct StoredRows {
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
inline Study study_of(std::uint32_t seed, int cases = 5) {
  Study study = fake_study(cases);
  if (seed % 2 == 0) study.kind = "bifurcation";
  return study;
}

inline std::map<std::string, std::string> expected_rows(const Study& study) {
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
inline void run_missing(const Study& study, std::vector<std::shared_ptr<WorkerHost>> hosts, StoredRows& kept,
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
  events.begins = [](std::span<const PendingCase>) {};
  events.finished = [&](const CaseRecord& record, const PendingCase*) {
    const std::lock_guard guard(kept.mutex);
    kept.rows[record.id] = to_bytes(record);
    ++kept.told[record.id];
  };
  run_cases(runner, std::move(pending), isolated.cases_at_once(), stop, events);
}

inline ScriptedWorld& prepare(ScriptedWorld& world, const Study& study, std::uint32_t seed, double crashes) {
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
inline Outcome run_scripts(const Study& study, std::uint32_t seed, const std::vector<Fate>& fates, StoredRows& kept,
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

inline void check_all(const Study& study, const StoredRows& kept) {
  CHECK((kept.rows == expected_rows(study)));
  for (const auto& [id, times] : kept.told) CHECK(times == 1);
}

inline constexpr double long_silence = 60;      // s
inline constexpr double none = 0, some = 0.15;  // share of units whose first attempt ends its worker

}  // namespace agents_tests
