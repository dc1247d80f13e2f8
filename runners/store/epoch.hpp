#pragma once
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>

#include "runners/store/run_identity.hpp"

namespace ricochet {

/// Which run a store belongs to: a number that each run raises when it begins, with the name of that run. A lock on the
/// folder says the same where locks hold. On some file systems each node keeps its own locks, and a scheduler may start
/// a job again while its first start lives on. Whoever finds another number than its own has lost the store.
///
/// Both functions are called within the transaction that they speak of.
class Epoch {
 public:
  /// Takes the store over. Throws StoreError where it belongs to a later start of the same job.
  void raise(SQLite::Database& database, const std::filesystem::path& file);
  /// Throws StoreError, naming the run, where another one has taken the store over since. Nothing before raise().
  void check(SQLite::Database& database, const std::filesystem::path& file) const;

 private:
  long long number_ = 0;  // 0: none yet
};

/// Writes that follow each other closely reach the disk together: making one durable takes a few ms, whatever it holds,
/// and a study may have thousands of cases of less than one. A write is durable when it returns, unless one became so
/// less than half a second before; then it is at the end of that half second, or when enough waits. Readers of the file
/// see what is durable.
///
/// Every function is called with `mutex` locked, which belongs to whoever uses the database. What a write throws takes
/// its own rows back. A failure that shows later is thrown by the next call.
class WriteGroup {
 public:
  /// What a killed process may lose of what it has written, s.
  static constexpr double longest = 0.5;
  /// Bytes that may wait; a larger write waits for none and with none.
  static constexpr std::size_t most_waiting = 1 << 20;

  /// `begun` is called when a transaction was begun, and ends it by what it throws.
  WriteGroup(SQLite::Database& database, std::mutex& mutex, std::function<void()> begun = {});
  ~WriteGroup();
  WriteGroup(const WriteGroup&) = delete;
  WriteGroup& operator=(const WriteGroup&) = delete;

  /// All the rows of one write, or none of them; about so many bytes.
  void write(std::size_t bytes, const std::function<void()>& rows);
  /// The same, durable when it returns, in a transaction of its own.
  void write_alone(const std::function<void()>& rows);
  /// Makes durable what waits.
  void commit();

 private:
  using Clock = std::chrono::steady_clock;
  void keep_pace(std::stop_token stop);
  void begin();
  void take_back();
  static void step(SQLite::Statement& statement);

  SQLite::Database& database_;
  std::mutex& mutex_;
  const std::function<void()> begun_;
  SQLite::Statement own_, kept_;  // around one write: its own rows can be taken back
  bool waiting_ = false;          // a transaction is open
  std::size_t bytes_ = 0;         // that wait
  Clock::time_point due_ = {};    // when what is written next, or waits, is to be durable
  std::exception_ptr failure_;
  std::condition_variable_any changed_;
  std::jthread pace_;  // last: it uses all of the above
};

}  // namespace ricochet
