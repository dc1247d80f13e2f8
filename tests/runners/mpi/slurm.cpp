/// A study in jobs of Slurm on two nodes: the tables that threads make, whatever happens to the job.
#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>

#include "runners/command/manual.hpp"
#include "runners/run/exit_code.hpp"
#include "tests/places.hpp"
#include "tests/runners/mpi/cluster.hpp"
#include "tests/runners/same_tables.hpp"
#include "tests/runners/workers/linger.hpp"

using ricochet::tests::places;
using namespace launch;
using Catch::Contains;
using lingering::comes_true;
using quick_studies::Json;
using quick_studies::study_of;
using same_tables::check_same;
namespace fs = std::filesystem;

namespace {

bool ended(const std::string& state) {
  return state == "COMPLETED" || state == "FAILED" || state == "CANCELLED" || state == "TIMEOUT" ||
         state == "NODE_FAIL";
}

/// The job script that the command prints, for a study in OUT.json.
std::string script(const ScratchFolder& scratch, const Json& study, const std::string& out,
                   const std::string& options = "") {
  write_text(scratch / (out + ".json"), study.dump());
  const Ended printed =
      to_its_end(scratch, program("slurm '" + (scratch / (out + ".json")).string() + "' --out '" +
                                  (scratch / out).string() + "' --nodes 2 --cpus 2 --time 10" + options));
  INFO(printed.messages);
  REQUIRE(printed.code == 0);
  return printed.out;
}

/// A job of the script with a study that lingers, once it marches.
std::string job_under_way(const Cluster& cluster, const ScratchFolder& scratch) {
  const std::string job = cluster.submit(script(scratch, lingering::study(), "out", lingering::plugin));
  REQUIRE(comes_true([&] { return lingering::marches(scratch / "out") || ended(cluster.of_job(job, "JobState")); }));
  REQUIRE(cluster.of_job(job, "JobState") == "RUNNING");
  return job;
}

/// The job, which goes back into the queue, is started again soon and not after two minutes, each time, and ends.
void goes_on(const Cluster& cluster, const std::string& job) {
  std::string state, started = "0";
  REQUIRE(comes_true([&] {
    state = cluster.of_job(job, "JobState");
    const std::string now = cluster.of_job(job, "Restarts");
    if (state == "PENDING" && now != started && cluster.rests()) {
      started = now;
      // A node takes a job of the second in which it was told to end it for the one that it ended.
      ::sleep(2);
      cluster.answer("scontrol update JobId=" + job + " StartTime=now");
    }
    return ended(state);
  }));
  INFO(read_text(cluster.job_output()));
  CHECK(started != "0");
  CHECK(state == "COMPLETED");
}

#define WITH_A_CLUSTER(cluster) \
  if (without_slurm()) return;  \
  const Cluster cluster;        \
  INFO(cluster.failure());      \
  REQUIRE(cluster.failure() == "")

}  // namespace

TEST_CASE(
    "slurm: ranks that srun starts on two nodes make the tables that threads make, its exit code is the command's") {
  WITH_A_CLUSTER(cluster);
  const ScratchFolder scratch;
  const std::string srun = "srun --mpi=pmix --kill-on-bad-exit=1 -N2 -n2 ";
  for (const char* kind : {"trajectory", "bifurcation"}) {
    CAPTURE(kind);
    const std::string out = std::string("ranks-") + kind;
    const Json study = study_of(kind);
    REQUIRE(to_its_end(scratch, program(run_words(scratch, study, kind))).code == 0);
    const std::string words = srun + ranks_program() + " run " + (scratch / (out + ".json")).string() +
                              " --jobs 2 --out " + (scratch / out).string();
    run_words(scratch, study, out);
    const Ended done = to_its_end(scratch, cluster.line(words));
    INFO(done.messages);
    CHECK(done.code == 0);
    CHECK_THAT(done.messages, Contains("4 workers on 1 machine, 2 ranks"));
    check_same(scratch / kind, scratch / out);
  }
  const Ended wrong = to_its_end(scratch, cluster.line(srun + ranks_program() + " run none.json"));
  CHECK(wrong.code == 2);
  CHECK(wrong.told("none.json: cannot be read") == 1);
}

TEST_CASE("slurm: the script that the command prints is a job that runs to its end") {
  WITH_A_CLUSTER(cluster);
  const ScratchFolder scratch;
  const Json study = study_of("basins");
  REQUIRE(to_its_end(scratch, program(run_words(scratch, study, "threads"))).code == 0);
  const std::string job = cluster.submit(script(scratch, study, "out"));
  CHECK(comes_true([&] { return ended(cluster.of_job(job, "JobState")); }));
  INFO(read_text(cluster.job_output()));
  CHECK(cluster.of_job(job, "JobState") == "COMPLETED");
  CHECK_THAT(read_text(cluster.job_output()), Contains(" on 1 machine, 2 ranks"));
  check_same(scratch / "threads", scratch / "out");
}

TEST_CASE("slurm: a job whose ranks were never started has not ended well, whatever srun says, and is tried again") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  const std::string job = script(scratch, study_of("trajectory"), "out");
  write_text(scratch / "job.sh", job);
  const auto stand_in = [&](const std::string& name, const std::string& does) {
    write_text(scratch / name, "#!/bin/sh\n" + does + "\n");
    fs::permissions(scratch / name, fs::perms::owner_all);
  };
  stand_in("scontrol", "echo $1 $2");
  stand_in("sleep", "");
  const std::string line = "env SLURM_JOB_ID=4711 SLURM_CPUS_PER_TASK=2 PATH='" + scratch.path().string() +
                           "':$PATH sh '" + (scratch / "job.sh").string() + "'";
  stand_in("srun", "exit 0");
  const Ended never = to_its_end(scratch, line);
  CHECK(never.code == 1);
  CHECK(never.out == "requeue 4711\n");
  stand_in("srun", "'" + places().command + "' " + run_words(scratch, study_of("trajectory"), "out"));
  // The second time there is nothing left to run.
  for (int time = 0; time < 2; ++time) {
    const Ended ran = to_its_end(scratch, line);
    INFO(ran.messages);
    CHECK(ran.code == 0);
    CHECK_THAT(ran.out, !Contains("requeue"));
  }
  stand_in("srun", "exit 0");
  CHECK(to_its_end(scratch, line).code == 1);
  CHECK_FALSE(fs::exists(scratch / "out/.started"));
}

TEST_CASE("slurm: a job goes back into the queue after a bug, an interruption or a signal, and after no other code") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  write_text(scratch / "job.sh", script(scratch, study_of("trajectory"), "out"));
  const auto stand_in = [&](const std::string& name, const std::string& does) {
    write_text(scratch / name, "#!/bin/sh\n" + does + "\n");
    fs::permissions(scratch / name, fs::perms::owner_all);
  };
  stand_in("scontrol", "echo $1 $2");
  stand_in("sleep", "");
  const std::string report = "'" + (scratch / "out/report.html").string() + "'";
  std::vector<int> codes{143};  // SIGTERM
  for (const ricochet::ExitMeaning& meaning : ricochet::exit_meanings()) codes.push_back(meaning.code);
  for (const int code : codes) {
    CAPTURE(code);
    stand_in("srun", "/bin/sleep 0.05; echo >" + report + "; exit " + std::to_string(code));
    const Ended ended =
        to_its_end(scratch, "env SLURM_JOB_ID=4711 SLURM_CPUS_PER_TASK=2 PATH='" + scratch.path().string() +
                                "':$PATH sh '" + (scratch / "job.sh").string() + "'");
    CHECK(ended.code == code);
    const bool again = code == ricochet::exit_bug || code == ricochet::exit_interrupted || code == 143;
    CHECK(ended.out == (again ? "requeue 4711\n" : ""));
  }
}

TEST_CASE("slurm: a job that is warned by USR1 keeps what it has, goes back into the queue and on to the same tables") {
  WITH_A_CLUSTER(cluster);
  const ScratchFolder scratch;
  REQUIRE(to_its_end(scratch, program(run_words(scratch, lingering::study(), "threads") + lingering::plugin)).code ==
          0);
  const lingering::Held held;
  const std::string job = job_under_way(cluster, scratch);
  cluster.answer("scancel --signal=USR1 " + job);
  REQUIRE(comes_true([&] { return cluster.of_job(job, "JobState") != "RUNNING"; }));
  held.let_go();
  goes_on(cluster, job);
  const std::string said = read_text(cluster.job_output());
  INFO(said);
  CHECK_THAT(said, Contains("interrupted: "));
  check_same(scratch / "threads", scratch / "out");
}

TEST_CASE("slurm: a job that loses a node goes back into the queue and on to the same tables") {
  WITH_A_CLUSTER(cluster);
  const ScratchFolder scratch;
  REQUIRE(to_its_end(scratch, program(run_words(scratch, lingering::study(), "threads") + lingering::plugin)).code ==
          0);
  const lingering::Held held;
  const std::string job = job_under_way(cluster, scratch);
  cluster.cut_off("n2");
  REQUIRE(comes_true([&] { return cluster.of_job(job, "Restarts") == "1"; }));
  held.let_go();
  cluster.switch_on("n2");
  goes_on(cluster, job);
  INFO(read_text(cluster.job_output()));
  check_same(scratch / "threads", scratch / "out");
}
