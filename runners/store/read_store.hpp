#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runners/store/folder_lock.hpp"
#include "runners/store/record.hpp"
#include "runners/store/store.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// Opens FOLDER/results.sqlite, which is there. Throws StoreError.
std::unique_ptr<SQLite::Database> open_store(const std::filesystem::path& folder);

/// The same, for `use`.
void with_store(const std::filesystem::path& folder, const std::function<void(SQLite::Database&)>& use);

/// Reads every table in one read transaction: the state after some whole number of finished cases. The series of these
/// are read when somebody asks for them. `compared`: each case was compared with its checksums, or written, by this
/// process.
StudyResults read_tables(SQLite::Database& database, bool compared = false);

/// What it holds of the study, and the environment; no cases.
StudyResults read_head(SQLite::Database& database);

/// One case, whole; nothing where there is none of this id.
std::optional<CaseRecord> read_case(SQLite::Database& database, const std::string& id);

/// The part of its study that the store holds; nothing where it holds none yet.
std::optional<StudyPart> read_part(SQLite::Database& database);

/// What is kept under a whole key of the motions; "" where nothing is.
std::string find_motion(SQLite::Database& database, const std::string& whole_key);

/// Where the stored cases ran.
Environment read_environment(SQLite::Database& database);

/// FOLDER/results.sqlite, read case by case: what it holds may be larger than the memory. Errors are StoreError.
class StoreReader {
 public:
  explicit StoreReader(const std::filesystem::path& folder);

  /// What is not as it was stored, looked for once.
  const Damage& damage() const;
  /// The study and the environment, without cases.
  StudyResults head() const;
  /// A case that is finished, and what tells whether it is still that of the study.
  struct Finished {
    std::string id, fingerprint;
    bool refused = false;
    std::string arithmetic;
  };
  /// In the study's order; what is damaged is left out.
  std::vector<Finished> finished() const;
  /// A case that finished() names.
  CaseRecord read(const std::string& id) const;

  /// The keys of Store::motion() for runs of this arithmetic, and what is kept under one of them.
  std::vector<std::string> motion_keys(const std::string& arithmetic) const;
  std::string motion(const std::string& key, const std::string& arithmetic) const;

 private:
  std::filesystem::path file_;
  std::unique_ptr<SQLite::Database> database_;
  mutable std::optional<Damage> damage_;
};

/// How far the run of a folder is, as its store tells anybody who may read it.
struct RunStatus {
  std::string name, question, kind;
  int expected = 0;
  StudyPart part;                   ///< of the study, whose cases are expected
  std::map<std::string, int> rows;  ///< status → finished cases
  int partial = 0;                  ///< rows of cases under way
  struct UnderWay {
    std::string id, stage, since;  ///< UTC
  };
  std::vector<UnderWay> under_way;
  std::optional<RunIdentity> run;  ///< the one that began last
  std::string progress, heard;     ///< what it last said of itself, and when (UTC); "" once it has ended in order
  double silent = 0;               ///< s since the store was last written to
};

/// Reads it without reading results. Throws StoreError where there is no store.
RunStatus read_status(const std::filesystem::path& folder);

}  // namespace ricochet
