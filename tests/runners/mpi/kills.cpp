/// kill -9 at random moments, of whatever a run on several ranks consists of. Nothing that was kept is lost, and the
/// same command goes on to the same tables. RICOCHET_KILLS=100 kills so many of each.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <random>

#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/mpi/launch.hpp"
#include "tests/runners/same_tables.hpp"
#include "tests/runners/workers/linger.hpp"

using namespace launch;
using Catch::Contains;
using quick_studies::Json;
using quick_studies::study_of;
using same_tables::check_same;
using same_tables::rows_of;
namespace fs = std::filesystem;

namespace {

int kills() {
  const char* text = std::getenv("RICOCHET_KILLS");
  constexpr int usual = 4;
  return text ? std::atoi(text) : usual;
}

/// Finished cases that the store holds; 0 where there is none yet.
int finished(const fs::path& out) {
  try {
    const auto cases = ricochet::read_store(out).cases;
    return static_cast<int>(std::count_if(cases.begin(), cases.end(), [](const auto& one) { return !one.partial; }));
  } catch (const ricochet::StoreError&) {
    return 0;
  }
}

void check_no_failed_row(const fs::path& out) {
  for (const auto& row : rows_of(out / "values.csv")) CHECK(row.at("status") != "failed");
  for (const auto& row : rows_of(out / "cases.csv")) CHECK(row.at("status") == "done");
}

/// Some seconds of orbits, in six cases.
Json sweep() {
  Json study = study_of("bifurcation");
  study["steps_per_period"] = 1500;
  study["mesh"]["elements"] = {3, 4, 5};
  study["refine"] = nullptr;
  return study;
}

using Victims = std::function<std::vector<pid_t>(const UnderWay&)>;
using Seconds = std::chrono::duration<double>;

/// Those that live, waited for until there are some or the run has ended.
std::vector<pid_t> wait_for(const Victims& victims, const UnderWay& run) {
  std::vector<pid_t> found = victims(run);
  for (; found.empty() && !run.ended(); found = victims(run)) ::usleep(1000);
  return found;
}

/// Seconds from the first look at which there are victims to the last one, in a run that nobody disturbs.
double time_of(const Victims& victims, const ScratchFolder& scratch, const std::string& line) {
  UnderWay run(scratch, line);
  REQUIRE_FALSE(wait_for(victims, run).empty());
  const auto first = std::chrono::steady_clock::now();
  auto last = first;
  for (; !run.ended(); ::usleep(5000))
    if (!victims(run).empty()) last = std::chrono::steady_clock::now();
  REQUIRE(run.finish().code == 0);
  return Seconds(last - first).count();
}

/// Kills, again and again, one of those that `victims` finds, at a random moment of their life. The moment counts from
/// when there are any: how long a machine takes until then says nothing.
void kill_at_random(const Victims& victims, bool survives) {
  const ScratchFolder scratch;
  const Json study = sweep();
  REQUIRE(to_its_end(scratch, program(run_words(scratch, study, "here") + " --inline")).code == 0);
  double lasts = time_of(victims, scratch, ranks(2, run_words(scratch, study, "undisturbed")));
  int killed = 0;
  for (int i = 0; killed < kills(); ++i) {
    std::mt19937 luck(static_cast<std::uint32_t>(i));
    const double moment = std::uniform_real_distribution<double>(0, lasts)(luck);
    CAPTURE(i, moment, lasts);
    const std::string words = run_words(scratch, study, "out");
    fs::remove_all(scratch / "out");
    Ended ended;
    {
      UnderWay run(scratch, ranks(2, words));
      wait_for(victims, run);
      ::usleep(static_cast<useconds_t>(1e6 * moment));
      const std::vector<pid_t> found = victims(run);
      if (!found.empty() && ::kill(found[luck() % found.size()], SIGKILL) == 0)
        ++killed;
      else
        lasts = moment;  // a machine that has become faster, or has less else to do
      ended = run.finish();
    }
    INFO(ended.messages);
    if (!survives && ended.code != 0) {
      const int before = finished(scratch / "out");
      const Ended again = to_its_end(scratch, ranks(2, words));
      INFO(again.messages);
      CHECK_THAT(again.messages, Contains(std::to_string(before) + " finished before"));
      ended.code = again.code;
    }
    CHECK(ended.code == 0);
    check_same(scratch / "here", scratch / "out");
    check_no_failed_row(scratch / "out");
  }
}

}  // namespace

TEST_CASE("kills: a worker, here or with another rank, costs nothing but time") {
  if (without_mpi()) return;
  kill_at_random([](const UnderWay& run) { return run.below("ricochet worker"); }, true);
}

TEST_CASE("kills: an agent ends the run under mpirun, the next one goes on") {
  if (without_mpi()) return;
  kill_at_random([](const UnderWay& run) { return ranks_below(run, -1); }, false);
}

TEST_CASE("kills: rank 0 ends the run, the next one goes on") {
  if (without_mpi()) return;
  kill_at_random([](const UnderWay& run) { return ranks_below(run, 0); }, false);
}

TEST_CASE("kills: of two starts of one job on one folder the later one has it, the earlier one ends with 5") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  const Json study = lingering::study();
  REQUIRE(to_its_end(scratch, program(run_words(scratch, study, "here") + " --inline" + lingering::plugin)).code == 0);
  const std::string words = ranks_program() + " " + run_words(scratch, study, "out") + lingering::plugin;
  // CommandOutput behind mpirun, which asks Slurm for nodes where it sees a job of it.
  const auto start = [&](int restart) {
    return mpirun("-n 2 env SLURM_JOB_ID=4711 SLURM_RESTART_COUNT=" + std::to_string(restart) + " " + words);
  };
  const lingering::Held held;
  UnderWay first(scratch, start(0));
  REQUIRE(lingering::comes_true([&] { return first.ended() || lingering::marches(scratch / "out"); }));
  REQUIRE_FALSE(first.ended());
  const ScratchFolder elsewhere;
  UnderWay second(elsewhere, start(1));
  // It has the folder when it tells of its workers.
  REQUIRE(lingering::comes_true(
      [&] { return second.ended() || read_text(elsewhere / "told").find(" workers on ") != std::string::npos; }));
  CHECK_FALSE(first.ended());
  held.let_go();
  const Ended went_on = second.finish();
  INFO(went_on.messages);
  CHECK(went_on.code == 0);
  const Ended ended = first.finish();
  INFO(ended.messages);
  CHECK(ended.code == 5);
  CHECK(ended.told("another run took this folder over") == 1);
  check_same(scratch / "here", scratch / "out");
  CHECK_FALSE(fs::exists(scratch / "out/results.lock"));
}
