#include "runners/store/schema.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Exception.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/case_id.hpp"

namespace ricochet {
namespace {

// series: IEEE-754 doubles, little-endian, one after the other. axes.value and study.value: JSON text.
constexpr const char* kStudyTables = R"sql(
CREATE TABLE study(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE environment(position INTEGER PRIMARY KEY, name TEXT NOT NULL, value TEXT NOT NULL);
CREATE TABLE cases(
  id TEXT PRIMARY KEY, position INTEGER NOT NULL, fingerprint TEXT NOT NULL,
  status TEXT NOT NULL CHECK(status IN ('done', 'refused', 'diverged', 'failed')), reason TEXT NOT NULL,
  steps INTEGER NOT NULL, setup_seconds REAL NOT NULL, run_seconds REAL NOT NULL, operator TEXT NOT NULL);
)sql";

// What belongs to a case; {0}: the prefix of its tables, {1}: the key of its case. The rows lie in their key: no
// index beside them repeats it.
constexpr const char* kRowTables = R"sql(
CREATE TABLE {0}axes(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  name TEXT NOT NULL, value TEXT NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
CREATE TABLE {0}measures(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  name TEXT NOT NULL, value REAL NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
CREATE TABLE {0}left_out(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  item TEXT NOT NULL, reason TEXT NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
CREATE TABLE {0}notes(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  note TEXT NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
CREATE TABLE {0}curves(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  name TEXT NOT NULL, series BLOB NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
)sql";

// What version 2 adds. case_tables.content: JSON {columns, rows}. motions: references, computed once, by what
// determines them.
constexpr const char* kLaterRowTables = R"sql(
CREATE TABLE {0}case_tables(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  name TEXT NOT NULL, content TEXT NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
)sql";
constexpr const char* kMotionTable = "CREATE TABLE motions(key TEXT PRIMARY KEY, content BLOB NOT NULL);";

// What version 3 adds: one row per column of a table of numbers. words: JSON list where the numbers are indices into
// one.
constexpr const char* kNumberTables = R"sql(
CREATE TABLE {0}case_numbers(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL, part INTEGER NOT NULL,
  name TEXT NOT NULL, exported INTEGER NOT NULL, column_name TEXT NOT NULL, words TEXT, series BLOB NOT NULL,
  PRIMARY KEY(case_id, position, part)) WITHOUT ROWID;
)sql";

// What version 4 adds: the cases whose code may be running, until their row is there. stage: 'plan' (their cost is
// being predicted), 'run'.
constexpr const char* kBegunTable = R"sql(
CREATE TABLE begun(
  case_id TEXT PRIMARY KEY, stage TEXT NOT NULL CHECK(stage IN ('plan', 'run')), since TEXT NOT NULL);
)sql";

// What version 5 adds: the cases of earlier versions of the study, with all that belongs to them, in tables of their
// own. There the case_id of a row is the fingerprint of its case. Where these cases ran is JSON, [[name, value], …].
constexpr const char* kAsideTables = R"sql(
CREATE TABLE aside_environments(id INTEGER PRIMARY KEY, entries TEXT NOT NULL UNIQUE);
CREATE TABLE aside_cases(
  fingerprint TEXT PRIMARY KEY, id TEXT NOT NULL, environment INTEGER NOT NULL REFERENCES aside_environments(id),
  status TEXT NOT NULL, reason TEXT NOT NULL,
  steps INTEGER NOT NULL, setup_seconds REAL NOT NULL, run_seconds REAL NOT NULL, operator TEXT NOT NULL);
)sql";

// Version 6 adds the run that the store belongs to (its RunIdentity, as JSON). It adds to each case the digest of the
// processor's arithmetic that it was computed with, "" where that is not known. In version 7 large tables lie in
// pieces: rows of the same name that follow each other are one table.
constexpr const char* kEpochTable = "CREATE TABLE epoch(number INTEGER PRIMARY KEY, run TEXT NOT NULL);";
constexpr const char* kArithmeticColumns = R"sql(
ALTER TABLE cases ADD COLUMN arithmetic TEXT NOT NULL DEFAULT '';
ALTER TABLE aside_cases ADD COLUMN arithmetic TEXT NOT NULL DEFAULT '';
)sql";

// Version 8 adds checksums (checksums.hpp): of a case with all that belongs to it, and of its place; of what is
// computed once. Those of the study are a value of it.
constexpr const char* kSumTables = R"sql(
CREATE TABLE {0}sums(
  case_id TEXT PRIMARY KEY REFERENCES {0}cases({1}) ON DELETE CASCADE, sum TEXT NOT NULL, place TEXT NOT NULL) WITHOUT ROWID;
)sql";
constexpr const char* kMotionSumTable =
    "CREATE TABLE motion_sums(key TEXT PRIMARY KEY REFERENCES motions(key) ON DELETE CASCADE, sum TEXT NOT NULL);";

// Version 9 adds the sentences that cases.reason is made of, and where their numbers stand: JSON [[begin, size], …].
constexpr const char* kReasonTable = R"sql(
CREATE TABLE {0}reasons(
  case_id TEXT NOT NULL REFERENCES {0}cases({1}) ON DELETE CASCADE, position INTEGER NOT NULL,
  excluded INTEGER NOT NULL, reason TEXT NOT NULL, marks TEXT NOT NULL, PRIMARY KEY(case_id, position)) WITHOUT ROWID;
)sql";

void create(SQLite::Database& database, const char* tables, const char* prefix = "", const char* key = "id") {
  database.exec(fmt::format(fmt::runtime(tables), prefix, key));
}

/// Brings a store from `version` (0: an empty one) to this program's.
void create_from(SQLite::Database& database, int version) {
  if (version < 1) {
    database.exec(kStudyTables);
    create(database, kRowTables);
  }
  if (version < 2) {
    create(database, kLaterRowTables);
    database.exec(kMotionTable);
  }
  if (version < 3) create(database, kNumberTables);
  if (version < 4) database.exec(kBegunTable);
  if (version < 5) {
    database.exec(kAsideTables);
    for (const char* tables : {kRowTables, kLaterRowTables, kNumberTables})
      create(database, tables, "aside_", "fingerprint");
  }
  if (version < 6) {
    database.exec(kEpochTable);
    database.exec(kArithmeticColumns);
  }
  if (version < 9) {
    create(database, kReasonTable);
    create(database, kReasonTable, "aside_", "fingerprint");
  }
  if (version < 8) {
    create(database, kSumTables);
    create(database, kSumTables, "aside_", "fingerprint");
    database.exec(kMotionSumTable);
    // Of an earlier program: what is there counts as whole.
    if (version > 0) {
      for (const char* prefix : {"", "aside_"}) seal_cases(database, prefix);
      seal_study(database);
    }
  }
  database.exec(fmt::format("PRAGMA user_version={};", kStoreVersion));
}

[[noreturn]] void not_ours(const std::filesystem::path& file) {
  throw StoreError(fmt::format(
      "{}: this file is not a Ricochet store; move it away or choose another folder with --out", file.string()));
}

/// What the system said to what failed; 0 where that is not known.
int system_error(const SQLite::Exception& error, const SQLite::Database* database) {
  if (database == nullptr) return errno;
  int said = sqlite3_system_errno(database->getHandle());
  // Of a write that fails where a transaction ends the file alone knows.
  if (said == 0 && (error.getErrorCode() & 0xff) == SQLITE_IOERR)
    sqlite3_file_control(database->getHandle(), "main", SQLITE_FCNTL_LAST_ERRNO, &said);
  return said;
}

std::string sentence(const SQLite::Exception& error, const SQLite::Database* database) {
  const int said = system_error(error, database);
  const std::string cause = said != 0 ? std::strerror(said) : error.getErrorStr();
  switch (error.getErrorCode() & 0xff) {
    case SQLITE_FULL:
      return "the disk is full; free some space and run the same command again: the cases that finished are kept";
    case SQLITE_IOERR:
      return fmt::format(
          "read or write error ({}); the cases that finished are kept: run the same command again once that is solved",
          cause);
    case SQLITE_READONLY:
      if (error.getExtendedErrorCode() == SQLITE_READONLY_DBMOVED)
        return "another run put a new store in the place of this one; this run has changed nothing since";
      [[fallthrough]];
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return fmt::format("cannot be opened for writing ({})", cause);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program is using this file; close it and run the same command again";
    case SQLITE_NOTADB:
      return "this file is not a Ricochet store; move it away or choose another folder with --out";
    case SQLITE_CORRUPT:
      return "pages of this store are damaged; `ricochet merge FOLDER --out NEW` keeps the cases that are whole, "
             "--fresh forgets it";
    default:
      return fmt::format("the store reports: {}", error.what());
  }
}

std::uint32_t big_endian(const std::array<unsigned char, 100>& header, std::size_t at) {
  return std::uint32_t{header[at]} << 24U | std::uint32_t{header[at + 1]} << 16U | std::uint32_t{header[at + 2]} << 8U |
         std::uint32_t{header[at + 3]};
}

}  // namespace

void guarded(const std::filesystem::path& file, const SQLite::Database* database, const std::function<void()>& work) {
  try {
    work();
  } catch (const SQLite::Exception& error) {
    throw StoreError(fmt::format("{}: {}", file.string(), sentence(error, database)));
  } catch (const nlohmann::json::exception& error) {
    throw StoreError(
        fmt::format("{}: this store is damaged ({}); forget it with --fresh", file.string(), error.what()));
  }
}

void prepare_schema(SQLite::Database& database, const std::filesystem::path& file, bool create) {
  guarded(file, &database, [&] {
    const int application = database.execAndGet("PRAGMA application_id").getInt();
    const int version = database.execAndGet("PRAGMA user_version").getInt();
    const int tables = database.execAndGet("SELECT count(*) FROM sqlite_master").getInt();
    if (application == 0 && version == 0 && tables == 0) {
      if (!create) throw StoreError(fmt::format("{}: this store is empty: run the study first", file.string()));
      SQLite::Transaction transaction(database);
      database.exec(fmt::format("PRAGMA application_id={};", kStoreApplication));
      create_from(database, 0);
      transaction.commit();
    } else if (application != kStoreApplication) {
      not_ours(file);
    } else if ((version == 7 || version == 8) && sqlite3_db_readonly(database.getHandle(), "main") == 1) {
      // It is read as it is: it lacks checksums, or the sentences of reasons apart.
      database.exec("CREATE TEMP TABLE reasons(case_id, position, excluded, reason, marks)");
    } else if (version >= 1 && version < kStoreVersion) {
      SQLite::Transaction transaction(database);
      create_from(database, version);
      transaction.commit();
    } else if (version != kStoreVersion) {
      throw StoreError(
          fmt::format("{}: this store has format version {}, this program reads and writes version {}. Run with "
                      "--fresh to forget it and run every case again, or choose another folder with --out",
                      file.string(), version, kStoreVersion));
    }
  });
}

void check_owner(const std::filesystem::path& file) {
  check_regular(file);
  // The header is read before SQLite has the file open: closing it later would drop SQLite's own locks.
  std::array<unsigned char, 100> header{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(header.data()), header.size());
  const auto size = static_cast<std::size_t>(stream.gcount());
  if (size == 0) return;
  // A first write cut short: SQLite rolls it back by its journal.
  if (size < header.size() && std::filesystem::exists(file.string() + "-journal")) return;
  constexpr std::size_t application_at = 68;
  const bool sqlite = size == header.size() && std::memcmp(header.data(), "SQLite format 3", 16) == 0;
  if (!sqlite || big_endian(header, application_at) != kStoreApplication) not_ours(file);
}

void forget_store(const std::filesystem::path& file) {
  check_owner(file);
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) {
    std::error_code error;
    std::filesystem::remove(file.string() + suffix, error);
    if (error) throw StoreError(fmt::format("{}{}: cannot be removed: {}", file.string(), suffix, error.message()));
  }
}

namespace {

/// A text of SQL: a name in double quotes, a value in single ones.
std::string in_quotes(const std::string& text, char quote) {
  std::string result(1, quote);
  for (const char c : text) result += c == quote ? std::string(2, c) : std::string(1, c);
  return result + quote;
}

std::string expression(const std::string& column, const StudyResults& results) {
  static const std::set<std::string> own = {"status", "reason", "steps", "setup_seconds", "run_seconds"};
  if (column == "case") return "id";
  const bool axis = std::find(results.columns.begin(), results.columns.end(), column) != results.columns.end();
  if (!axis && own.count(column) != 0) return in_quotes(column, '"');
  return fmt::format("(SELECT {} FROM {} WHERE case_id = cases.id AND name = {})",
                     axis ? "json_extract(value, '$')" : "value", axis ? "axes" : "measures", in_quotes(column, '\''));
}

}  // namespace

void make_views(SQLite::Database& database, const StudyResults& results) {
  std::string columns;
  for (const Column& column : cases_table(results).columns)
    columns += fmt::format("{}{} AS {}", columns.empty() ? "" : ", ", expression(column.name, results),
                           in_quotes(column.name, '"'));
  database.exec("DROP VIEW IF EXISTS v_cases");
  database.exec(
      fmt::format("CREATE VIEW v_cases AS SELECT {} FROM cases WHERE fingerprint != '' ORDER BY position", columns));
}

}  // namespace ricochet
