#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <utility>

#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"

namespace ricochet {
namespace {

struct Holder {
  long long number = 0;
  RunIdentity run;
};

Holder holder_of(SQLite::Database& database) {
  Holder holder;
  SQLite::Statement row(database, "SELECT number, run FROM epoch");
  if (row.executeStep()) holder = {row.getColumn(0).getInt64(), RunIdentity::from_json(row.getColumn(1).getString())};
  return holder;
}

}  // namespace

void Epoch::raise(SQLite::Database& database, const std::filesystem::path& file) {
  const Holder before = holder_of(database);
  const RunIdentity me = this_run();
  if (before.run.succeeds(me))
    throw StoreError(fmt::format("{}: a later start of this job has taken this folder over ({})",
                                 file.parent_path().string(), before.run.text()));
  database.exec("DELETE FROM epoch");
  SQLite::Statement add(database, "INSERT INTO epoch(number, run) VALUES(?, ?)");
  add.bind(1, static_cast<std::int64_t>(before.number + 1));
  add.bind(2, me.to_json());
  add.exec();
  number_ = before.number + 1;
}

void Epoch::check(SQLite::Database& database, const std::filesystem::path& file) const {
  if (number_ == 0) return;
  if (const Holder now = holder_of(database); now.number != number_)
    throw StoreError(fmt::format("{}: another run took this folder over ({}); this one has changed nothing since",
                                 file.parent_path().string(), now.run.text()));
}

WriteGroup::WriteGroup(SQLite::Database& database, std::mutex& mutex, std::function<void()> begun)
    : database_(database),
      mutex_(mutex),
      begun_(std::move(begun)),
      own_(database, "SAVEPOINT own"),
      kept_(database, "RELEASE own"),
      pace_([this](std::stop_token stop) { keep_pace(std::move(stop)); }) {}

WriteGroup::~WriteGroup() {
  pace_.request_stop();
  pace_.join();
  const std::lock_guard guard(mutex_);
  try {
    commit();
  } catch (...) {
    // Whoever wants to know asks for it before.
  }
}

void WriteGroup::write(std::size_t bytes, const std::function<void()>& rows) {
  const bool large = bytes > most_waiting;
  if (large || failure_) commit();
  const bool first = !waiting_;
  if (first) begin();
  waiting_ = true;
  try {
    step(own_);
    rows();
    step(kept_);
  } catch (...) {
    // An error of the disk takes the whole transaction back.
    waiting_ = sqlite3_get_autocommit(database_.getHandle()) == 0;
    if (waiting_) database_.tryExec("ROLLBACK TO own; RELEASE own");
    throw;
  }
  bytes_ += bytes;
  if (large || bytes_ > most_waiting || Clock::now() >= due_)
    commit();
  else if (first)
    changed_.notify_all();
}

void WriteGroup::step(SQLite::Statement& statement) {
  statement.reset();
  statement.exec();
}

void WriteGroup::write_alone(const std::function<void()>& rows) {
  commit();
  begin();
  try {
    rows();
    database_.exec("COMMIT");
  } catch (...) {
    take_back();
    throw;
  }
}

void WriteGroup::begin() {
  database_.exec("BEGIN IMMEDIATE");
  try {
    if (begun_) begun_();
  } catch (...) {
    take_back();
    throw;
  }
}

void WriteGroup::take_back() {
  // An error of the disk has done it already.
  if (sqlite3_get_autocommit(database_.getHandle()) == 0) database_.tryExec("ROLLBACK");
}

void WriteGroup::commit() {
  if (const auto failure = std::exchange(failure_, nullptr)) std::rethrow_exception(failure);
  if (!waiting_) return;
  waiting_ = false;
  bytes_ = 0;
  try {
    database_.exec("COMMIT");
  } catch (...) {
    // What cannot be written now may not hold the file.
    take_back();
    throw;
  }
  due_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(longest));
}

void WriteGroup::keep_pace(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return waiting_; })) {
    const Clock::time_point due = due_;  // read by the waiting itself, which holds no lock
    changed_.wait_until(lock, stop, due, [this] { return !waiting_; });
    if (stop.stop_requested()) return;
    if (!waiting_ || Clock::now() < due_) continue;
    try {
      commit();
    } catch (...) {
      failure_ = std::current_exception();
    }
  }
}

}  // namespace ricochet
