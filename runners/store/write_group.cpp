#include "runners/store/write_group.hpp"

#include <sqlite3.h>

#include <utility>

namespace ricochet {

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
