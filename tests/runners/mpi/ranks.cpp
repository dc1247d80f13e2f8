/// One study on the ranks of mpirun, all on this machine: the tables that one process makes, one message for one
/// mistake.
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "core/loader/catalogue.hpp"
#include "runners/march/study_identity.hpp"
#include "tests/places.hpp"
#include "tests/runners/mpi/launch.hpp"
#include "tests/runners/same_tables.hpp"
#include "tests/runners/workers/linger.hpp"

using ricochet::tests::places;
using namespace launch;
using Catch::Contains;
using quick_studies::Json;
using quick_studies::study_of;
using quick_studies::stumbling;
using same_tables::check_same;
namespace fs = std::filesystem;

TEST_CASE("ranks: every kind of study has on one and on three ranks the tables that it has in one process") {
  if (without_mpi()) return;
  const std::string kind =
      GENERATE("trajectory", "convergence", "work-precision", "stability", "bifurcation", "basins");
  CAPTURE(kind);
  const ScratchFolder scratch;
  const Json study = study_of(kind);
  const Ended here = to_its_end(scratch, program(run_words(scratch, study, "here") + " --inline"));
  INFO(here.messages);
  REQUIRE(here.code == 0);
  for (const int count : {1, 3}) {
    CAPTURE(count);
    const std::string out = "ranks-" + std::to_string(count);
    const Ended ended = to_its_end(scratch, ranks(count, run_words(scratch, study, out)));
    INFO(ended.messages);
    CHECK(ended.code == 0);
    CHECK_THAT(ended.out, Contains("report: "));
    CHECK_THAT(ended.messages, Contains(std::to_string(2 * count) + " workers on 1 machine, " + std::to_string(count) +
                                        (count == 1 ? " rank" : " ranks")));
    check_same(scratch / "here", scratch / out, kind == "work-precision");
  }
}

TEST_CASE("ranks: what is wrong is said once, by rank 0, with the exit code of the command, nothing is written") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  Json wrong = study_of("trajectory");
  wrong["methods"]["contact"] = "signorin";
  struct Mistake {
    std::string words, sentence;
    int code;
  };
  const std::vector<Mistake> mistakes = {
      {"run '" + (scratch / "none.json").string() + "'", "none.json", 2},
      {run_words(scratch, wrong, "wrong"), "did you mean \"signorini\"", 2},
      {"run", "Usage: ricochet run", 2},
      {run_words(scratch, study_of("trajectory"), "here") + " --inline", "--inline is for one process", 2},
      {"plan x.json", "ricochet-mpi expects the command run", 2},
      {"", "ricochet-mpi expects the command run", 2},
  };
  for (const Mistake& one : mistakes) {
    CAPTURE(one.words);
    const Ended ended = to_its_end(scratch, ranks(3, one.words));
    INFO(ended.messages);
    CHECK(ended.code == one.code);
    CHECK(ended.told(one.sentence) == 1);
    CHECK(ended.out == "");
  }
  for (const char* folder : {"wrong", "here", "results"}) CHECK_FALSE(fs::exists(scratch / folder));
}

TEST_CASE(
    "ranks: orbits whose plugin ends their process are failed rows, with exit code 3, as in workers of one machine") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  const std::string plugin = " --plugin '" + places().stumbling + "'";
  const Json study = stumbling("segv", 7e-3);
  const Ended one = to_its_end(scratch, program(run_words(scratch, study, "workers") + " --isolate" + plugin));
  const Ended three = to_its_end(scratch, ranks(3, run_words(scratch, study, "ranks") + plugin));
  INFO(three.messages);
  CHECK(one.code == 3);
  CHECK(three.code == 3);
  CHECK_THAT(three.out, Contains("the process of an orbit ended"));
  check_same(scratch / "workers", scratch / "ranks");
}

TEST_CASE("ranks: one that computes other last digits is refused before anything is written") {
  if (without_mpi()) return;
  constexpr const char* other = "env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA ";
  const ScratchFolder scratch;
  const std::string words = run_words(scratch, study_of("trajectory"), "out");
  const std::string rank = " -n 1 ", next = " : -n 1 ", alone = "'" + ranks_program() + "' " + words;
  const Ended ended = to_its_end(scratch, mpirun(rank + alone + next + other + alone));
  INFO(ended.messages);
  if (ended.code == 0) {
    std::puts("skipped: this processor and C library have one arithmetic with and without FMA");
    return;
  }
  CHECK(ended.code == 2);
  CHECK(ended.told("rank 1 on ") == 1);
  CHECK(ended.told("computes other last digits than") == 1);
  CHECK_FALSE(fs::exists(scratch / "out"));
  // The coordinator is not always right: the one that differs is told by its rank, whichever it is.
  const Ended turned = to_its_end(scratch, mpirun(rank + other + alone + next + alone));
  CHECK(turned.code == 2);
  CHECK_FALSE(fs::exists(scratch / "out"));
}

TEST_CASE("ranks: one beside which the program is missing, or is another build, is refused and named") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  const std::string words = run_words(scratch, study_of("trajectory"), "out");
  const std::string line = ranks(1, words);
  const fs::path copy = scratch / "ricochet-mpi";
  fs::copy_file(ranks_program(), copy);
  const std::string second = " : -n 1 '" + copy.string() + "' " + words;
  const Ended missing = to_its_end(scratch, line + second);
  INFO(missing.messages);
  CHECK(missing.code == 2);
  CHECK(missing.told("rank 1 on ") == 1);
  CHECK_THAT(missing.messages, Contains((scratch / "ricochet").string() + ": cannot be read"));
  // Another build: a program whose linker has given it another id.
  fs::copy_file(places().command, scratch / "ricochet");
  std::string bytes = read_text(scratch / "ricochet");
  const std::size_t id = bytes.find(ricochet::build_id(places().command));
  REQUIRE(id != std::string::npos);
  bytes[id] = static_cast<char>(~bytes[id]);
  write_text(scratch / "ricochet", bytes);
  const Ended another = to_its_end(scratch, line + second);
  INFO(another.messages);
  CHECK(another.code == 2);
  CHECK(another.told("has another program than") == 1);
  CHECK_FALSE(fs::exists(scratch / "out"));
}

TEST_CASE("ranks: a run that USR1 stops ends with 130, leaves no worker behind, and goes on to the same tables") {
  if (without_mpi()) return;
  const ScratchFolder scratch;
  const Json study = lingering::study();
  REQUIRE(to_its_end(scratch, program(run_words(scratch, study, "here") + " --inline" + lingering::plugin)).code == 0);
  const std::string words = run_words(scratch, study, "out") + lingering::plugin;
  {
    const lingering::Held held;
    UnderWay run(scratch, ranks(3, words));
    REQUIRE(lingering::comes_true([&] { return run.ended() || lingering::marches(scratch / "out"); }));
    REQUIRE_FALSE(run.ended());
    const std::vector<pid_t> workers = run.below("ricochet worker");
    CHECK_FALSE(workers.empty());
    const Ended stopped = run.finish(SIGUSR1);
    INFO(stopped.messages);
    CHECK(stopped.code == 130);
    CHECK(stopped.told("interrupted: ") == 1);
    CHECK(lingering::comes_true(
        [&] { return std::none_of(workers.begin(), workers.end(), [](pid_t one) { return ::kill(one, 0) == 0; }); }));
  }
  const Ended again = to_its_end(scratch, ranks(2, words));
  INFO(again.messages);
  CHECK(again.code == 0);
  check_same(scratch / "here", scratch / "out");
}
