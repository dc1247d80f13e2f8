// Two runs that both believe a folder to be theirs: the later one has it, the earlier one changes nothing any more.
#include "runners/store/epoch.hpp"

#include <errno.h>

#include <catch2/catch.hpp>
#include <functional>

#include "runners/store/store.hpp"
#include "runners/store/store_error.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/store/sample_results.hpp"
#include "tests/runners/variable.hpp"

using namespace ricochet;

namespace epoch_tests {
using Catch::Contains;

namespace {

const std::vector<ExpectedCase> kBoth = {{"0123456789", "f1"}, {"abcdefabcd", "f2"}};

std::string bytes_of(const ScratchFolder& folder) {
  return read_text(folder / "results.sqlite");
}

}  // namespace

TEST_CASE("epoch: every write of a run that lost its folder is refused, names the other run and changes nothing") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  const Variable job("SLURM_JOB_ID", "4711"), restart("SLURM_RESTART_COUNT", {});
  Store first(folder.path(), false);
  first.begin(results, kBoth);
  first.save({results.cases.data(), 1});
  Store second = Store::unlocked(folder.path());
  CHECK(second.begin(results, kBoth) == std::set<std::string>{"0123456789"});
  const std::string before = bytes_of(folder);
  const std::vector<std::function<void()>> writes = {[&] {
                                                       first.save({results.cases.data() + 1, 1});
                                                     },
                                                     [&] {
                                                       first.save({results.cases.data() + 1, 1});
                                                     },
                                                     [&] { first.save_partial(results.cases[1]); },
                                                     [&] { first.begins({"abcdefabcd"}, Store::Stage::run); },
                                                     [&] { first.nothing_under_way(); },
                                                     [&] { first.save_motion("key", "content"); },
                                                     [&] {
                                                       first.save_environment({{{"program", "first"}}});
                                                     },
                                                     [&] { first.make_views(results); },
                                                     [&] { first.begin(results, {}); }};
  for (const auto& write : writes)
    CHECK_THROWS_WITH(write(),
                      Contains("another run took this folder over (process ") && Contains(", job 4711, started "));
  CHECK((bytes_of(folder) == before));
  second.save({results.cases.data() + 1, 1});
  CHECK(second.load().cases.size() == 2);
}

TEST_CASE("epoch: a run whose folder is taken from under it ends with 5, and the other's results stand") {
  const ScratchFolder scratch;
  const auto out = scratch / "out";
  const Study study = fake_study(6);
  FakeRun first(scratch), second(scratch);
  first.runner.cases.run = [&, done = 0](const StudyCase& one, const std::atomic<bool>&) mutable {
    if (++done == 3) {
      Store other = Store::unlocked(out);
      StudyResults same;
      same.name = study.name;
      other.begin(same, {});
    }
    return fake_result(one);
  };
  CHECK(first(study, {out, 1, false}) == 5);
  CHECK_THAT(first.messages, Contains("ricochet: ") && Contains("another run took this folder over"));
  CHECK_FALSE(std::filesystem::exists(out / "cases.csv"));
  CHECK(second(study, {out, 1, false}) == 0);
  CHECK(read_store(out).cases.size() == 6);
}

TEST_CASE("epoch: a later start of the same job takes the folder over although the earlier one holds its lock") {
  const ScratchFolder folder;
  const StudyResults results = sample_results();
  const Variable job("SLURM_JOB_ID", "815");
  std::optional<Store> second;
  {
    std::optional<Variable> restart(std::in_place, "SLURM_RESTART_COUNT", "1");
    Store first(folder.path(), false);
    first.begin(results, kBoth);
    CHECK_THROWS_WITH(Store(folder.path(), false), Contains("another run is using this folder") && Contains("job 815"));
    restart.reset();
    {
      const Variable other("SLURM_JOB_ID", "816"), later("SLURM_RESTART_COUNT", "7");
      CHECK_THROWS_WITH(Store(folder.path(), false), Contains("job 815 (restart 1)"));
    }
    const Variable later("SLURM_RESTART_COUNT", "2");
    second.emplace(folder.path(), false);
    second->begin(results, kBoth);
    CHECK_THROWS_WITH(first.save(results.cases), Contains("took this folder over") && Contains("job 815 (restart 2)"));
  }
  // The end of the first has not given the lock of the second away.
  CHECK(std::filesystem::exists(folder / "results.lock"));
  CHECK_THROWS_WITH(Store(folder.path(), false), Contains("another run is using this folder"));
  second->save(results.cases);
  second.reset();
  CHECK_FALSE(std::filesystem::exists(folder / "results.lock"));

  // An earlier start that comes late, where no lock holds it back.
  const Variable early("SLURM_RESTART_COUNT", "1");
  Store late = Store::unlocked(folder.path());
  CHECK_THROWS_WITH(late.begin(results, {}), Contains("a later start of this job has taken this folder over"));
  CHECK(late.load().cases.size() == 2);
}

TEST_CASE("epoch: a file system without locks is named as what it is") {
  const std::filesystem::path file = "/scratch/results/results.lock";
  for (const int error : {ENOSYS, EOPNOTSUPP})
    CHECK_THAT(lock_failure(file, error),
               Contains(file.string()) && Contains("\"flock\"") && Contains("Lustre") && Contains("--out"));
  CHECK_THAT(lock_failure(file, ENOLCK), Contains("lock service") && Contains("--out"));
  CHECK_THAT(lock_failure(file, EIO), Contains("cannot be locked: Input/output error"));
}

}  // namespace epoch_tests
