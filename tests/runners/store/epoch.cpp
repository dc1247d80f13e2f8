// Two runs that both believe a folder to be theirs: the later one has it, the earlier one changes nothing any more.
#include <SQLiteCpp/SQLiteCpp.h>
#include <errno.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <stdexcept>

#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"
#include "tests/runners/variable.hpp"

using namespace ricochet;

namespace epoch_tests {
using Catch::Contains;

namespace {

const std::vector<ExpectedCase> kBoth = {{"c0123456789", "f1"}, {"cabcdefabcd", "f2"}};

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
  CHECK(second.begin(results, kBoth) == std::set<std::string>{"c0123456789"});
  const std::string before = bytes_of(folder);
  const std::vector<std::function<void()>> writes = {[&] {
                                                       first.save({results.cases.data() + 1, 1});
                                                     },
                                                     [&] {
                                                       first.save({results.cases.data() + 1, 1});
                                                     },
                                                     [&] { first.save_partial(results.cases[1]); },
                                                     [&] { first.begins({"cabcdefabcd"}, Store::Stage::run); },
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

// Writes that follow each other closely are durable together, soon; none takes another one with it.
using namespace ricochet;

namespace {

/// A database of one table, and what another process would see of it.
struct Numbers {
  /// wait_ms: how long a commit waits for readers (SQLite's rollback journal lets none in while it commits).
  explicit Numbers(const ScratchFolder& folder, int wait_ms)
      : file(folder.path() / "numbers.sqlite"), database(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, wait_ms) {
    database.exec("CREATE TABLE numbers(n INTEGER)");
  }
  void write(WriteGroup& group, int n, std::size_t bytes = 0) {
    const std::lock_guard guard(mutex);
    group.write(bytes, [&] { database.exec("INSERT INTO numbers VALUES(" + std::to_string(n) + ")"); });
  }
  int seen() const {
    SQLite::Database reader(file, SQLite::OPEN_READONLY, 1000);
    return reader.execAndGet("SELECT count(*) FROM numbers").getInt();
  }
  /// Waited for, up to minutes on a busy machine.
  bool come_to_be_seen(int count) const {
    for (int tries = 30000; tries > 0 && seen() != count; --tries) ::usleep(10000);
    return seen() == count;
  }

  std::filesystem::path file;
  SQLite::Database database;
  std::mutex mutex;
};

}  // namespace

TEST_CASE("write group: the first write is durable at once, those right after it soon, without another call") {
  const ScratchFolder folder;
  Numbers numbers(folder, 10000);
  WriteGroup group(numbers.database, numbers.mutex);
  numbers.write(group, 0);
  CHECK(numbers.seen() == 1);
  for (int n = 1; n < 10; ++n) numbers.write(group, n);
  CHECK(numbers.come_to_be_seen(10));
  // What was durable longer ago does not hold up the next one.
  ::usleep(static_cast<useconds_t>(1.2e6 * WriteGroup::longest));
  numbers.write(group, 10);
  CHECK(numbers.seen() == 11);
}

TEST_CASE("write group: a large write is durable when it returns, and so is what waited") {
  const ScratchFolder folder;
  Numbers numbers(folder, 10000);
  WriteGroup group(numbers.database, numbers.mutex);
  for (int n = 0; n < 3; ++n) numbers.write(group, n);
  numbers.write(group, 3, WriteGroup::most_waiting + 1);
  CHECK(numbers.seen() == 4);
  // Many small ones together are large. Tried again where a busy machine took so long that one was due by itself.
  using Clock = std::chrono::steady_clock;
  int written = 4, seen = 0;
  for (bool none_due = false; !none_due;) {
    const Clock::time_point begin = Clock::now();
    numbers.write(group, 0, WriteGroup::most_waiting + 1);
    for (int n = 0; n < 5; ++n) numbers.write(group, n, WriteGroup::most_waiting / 4);
    written += 6;
    seen = numbers.seen();
    none_due = std::chrono::duration<double>(Clock::now() - begin).count() < WriteGroup::longest;
  }
  CHECK(seen == written);
}

TEST_CASE("write group: a write that throws takes its own rows back, and leaves those that wait") {
  const ScratchFolder folder;
  Numbers numbers(folder, 10000);
  {
    WriteGroup group(numbers.database, numbers.mutex);
    for (int n = 0; n < 3; ++n) numbers.write(group, n);
    const auto broken = [&] {
      const std::lock_guard guard(numbers.mutex);
      group.write(0, [&] {
        numbers.database.exec("INSERT INTO numbers VALUES(100)");
        throw std::runtime_error("no");
      });
    };
    CHECK_THROWS_AS(broken(), std::runtime_error);
    numbers.write(group, 3);
  }
  CHECK(numbers.seen() == 4);
  CHECK(numbers.database.execAndGet("SELECT max(n) FROM numbers").getInt() == 3);
}

TEST_CASE("write group: what cannot be made durable is told by the next call") {
  const ScratchFolder folder;
  Numbers numbers(folder, 0);
  WriteGroup group(numbers.database, numbers.mutex);
  numbers.write(group, 0);
  {
    SQLite::Database reader(numbers.file, SQLite::OPEN_READWRITE);
    SQLite::Statement open(reader, "SELECT n FROM numbers");
    REQUIRE(open.executeStep());  // a reader keeps the file from changing
    const auto both = [&] {
      numbers.write(group, 1);
      const std::lock_guard guard(numbers.mutex);
      group.commit();
    };
    CHECK_THROWS_AS(both(), SQLite::Exception);
  }
  numbers.write(group, 2);
  const std::lock_guard guard(numbers.mutex);
  group.commit();
  CHECK(numbers.seen() == 2);
}
