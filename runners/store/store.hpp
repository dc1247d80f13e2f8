#pragma once
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runners/store/folder_lock.hpp"
#include "runners/store/record.hpp"
#include "runners/store/statements.hpp"

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

/// Writes that follow each other closely reach the disk together. Making one durable takes a few ms, whatever it holds,
/// and a study may have thousands of cases of less than one. A write is durable when it returns, unless one became so
/// less than half a second before. Then it is at the end of that half second, or when enough waits. Readers of the file
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

/// What the study expects of one case, in the study's order.
struct ExpectedCase {
  std::string id;
  std::string fingerprint;
};

/// results.sqlite of one folder, opened for a run: the record of the study, of its environment and of each finished
/// case.
///
/// The folder is locked while a Store lives. Each call below is all or nothing. A process killed at any moment leaves
/// the store as it was after the last call that returned. What begins(), save() and save_progress() wrote in the last
/// half second may be missing (WriteGroup). Errors are StoreError, with the path, the cause and what to do.
class Store {
 public:
  /// Opens or creates FOLDER/results.sqlite; `fresh` forgets what it held. Refuses a store of another version.
  Store(const std::filesystem::path& folder, bool fresh) : Store(folder, fresh, true) {}
  /// The same without a lock on the folder, as where the locks of the file system hold nobody back. The epoch alone
  /// then keeps two runs apart.
  static Store unlocked(const std::filesystem::path& folder) { return {folder, false, false}; }

  /// States the study (name, question, kind, study, columns, expected_cases, part of `study`) and its cases. Stored
  /// cases that are not expected with their fingerprint are set aside; refused and unfinished ones of them are dropped.
  /// Those that were set aside and are expected now come back. The curves/ID.csv of all these are removed. Returns the
  /// ids of the cases that need not run. Refuses a store of another study. The store is this run's from here on. What
  /// an earlier one that still lives would write is refused, and nothing of it changes the store (Epoch). `arithmetic`:
  /// digest of the arithmetic of this run, kept with its cases; motions are found again under the same one only.
  std::set<std::string> begin(const StudyResults& study, const std::vector<ExpectedCase>& expected,
                              const std::string& arithmetic = "");
  /// The part of its study that the store holds, as the last begin() stated it; nothing where none has.
  std::optional<StudyPart> part() const;
  /// How many of them begin() brought back.
  int returned() const { return returned_; }
  /// The stored cases that begin() dropped because they were not as they were stored.
  const std::vector<std::string>& damaged() const { return damaged_; }
  /// How many cases of earlier versions of the study are kept aside.
  int aside() const;
  /// How many finished cases were computed with another arithmetic than this run's.
  int of_other_arithmetic() const;

  /// Where the stored cases ran.
  Environment environment() const;
  /// Replaces the environment.
  void save_environment(const Environment& environment);

  /// States that code of these cases is about to run: all of them, to predict their cost (`plan`), or one. What a
  /// killed run leaves of this is what it was at.
  enum class Stage { plan, run };
  void begins(const std::vector<std::string>& ids, Stage stage);
  /// The cases that were under way when the last run of this folder was killed, in no order.
  std::vector<std::string> left_under_way() const;
  /// The cases that failed.
  std::set<std::string> failed() const;
  /// No case is under way any more: the run ends in order.
  void nothing_under_way();

  /// How far the run is, in words, and now: for who looks from elsewhere (read_store.hpp).
  void save_progress(const std::string& text);

  /// Adds finished cases, which are no longer under way.
  /// Measures that are not finite are left out, with a note. May be called from several threads.
  void save(std::span<const CaseRecord> records);

  /// Adds what a running case has so far, to be shown and to be replaced by save(). A later begin() does not keep it;
  /// load() marks it as partial. May be called from several threads.
  void save_partial(const CaseRecord& record);

  /// What was computed once and serves several cases (a reference), or lets a case go on (a checkpoint). The key is
  /// what determines it; "" when there is none. Saving "" removes it.
  std::string motion(const std::string& key) const;
  void save_motion(const std::string& key, const std::string& content);

  /// Makes the views of these results anew (schema.hpp): for who reads the store with SQL.
  void make_views(const StudyResults& results);

  /// Everything the store holds; the series of finished cases are read when somebody asks for them. What begin() found
  /// whole is not compared with its checksums again.
  StudyResults load() const;

 private:
  Store(const std::filesystem::path& folder, bool fresh, bool locked);
  std::set<std::string> settle_rows();
  void write_environment(const Environment& environment);
  void write(std::size_t bytes, const std::function<void()>& rows);
  void write_alone(const std::function<void()>& rows);
  void note_begin(const std::string& id, Stage stage);
  void save_one(const CaseRecord& record, bool partial);
  void save_tables(const CaseRecord& record);
  void save_curve(const CaseRecord& record);
  void save_numbers(const CaseRecord& record);

  std::filesystem::path file_;
  std::optional<FolderLock> lock_;
  Epoch epoch_;
  std::string arithmetic_;
  std::unique_ptr<SQLite::Database> database_;
  std::map<std::string, std::pair<std::string, int>> expected_;  // id → fingerprint, position
  bool begun_ = false;  // all rows were compared with their checksums, or are this run's
  int returned_ = 0;
  std::vector<std::string> damaged_;
  std::set<std::string> rows_;  // ids that have one
  std::unique_ptr<Statements> prepared_;
  mutable std::mutex mutex_;
  std::unique_ptr<WriteGroup> group_;  // last: it uses what stands before
};

/// Everything that FOLDER/results.sqlite holds, without the right to change it: works while a run goes on. The series
/// of finished cases are read when somebody asks for them. Throws StoreError, also where something is damaged.
StudyResults read_store(const std::filesystem::path& folder);
/// The same of a store of which something is damaged: what is whole, the rest named (StudyResults::damage).
StudyResults read_what_is_whole(const std::filesystem::path& folder);

/// What FOLDER/results.sqlite keeps under a key of Store::motion for runs of this arithmetic, "" where there is none.
std::string read_motion(const std::filesystem::path& folder, const std::string& key, const std::string& arithmetic);

}  // namespace ricochet
