// Writes that follow each other closely are durable together, soon; none takes another one with it.
#include "runners/store/write_group.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <stdexcept>

#include "tests/runners/scratch_folder.hpp"

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
  bool seen_within(double seconds, int count) const {
    for (int tries = static_cast<int>(seconds * 100); tries > 0 && seen() != count; --tries) ::usleep(10000);
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
  CHECK(numbers.seen_within(20 * WriteGroup::longest, 10));  // a loaded machine may take its time
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
  // Many small ones together are large.
  for (int n = 0; n < 5; ++n) numbers.write(group, n, WriteGroup::most_waiting / 4);
  CHECK(numbers.seen() == 9);
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
