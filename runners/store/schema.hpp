#pragma once
#include <SQLiteCpp/Database.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runners/store/record.hpp"

namespace ricochet {

/// Identity of results.sqlite, in the file's header (PRAGMA application_id, user_version).
constexpr int kStoreApplication = 0x5249434F;  // "RICO"
constexpr int kStoreVersion = 9;

/// The columns of a case beside its id, its fingerprint and its place.
inline constexpr const char* kCaseColumns = "status, reason, steps, setup_seconds, run_seconds, operator, arithmetic";
/// The tables of what belongs to a case: name, columns beside case_id.
inline constexpr std::pair<const char*, const char*> kRowsOfCases[] = {
    {"axes", "position, name, value"},
    {"measures", "position, name, value"},
    {"left_out", "position, item, reason"},
    {"notes", "position, note"},
    {"reasons", "position, excluded, reason, marks"},
    {"curves", "position, name, series"},
    {"case_tables", "position, name, content"},
    {"case_numbers", "position, part, name, exported, column_name, words, series"}};

/// Creates the tables in an empty database, in one transaction; checks the identity of one that is not empty. A store
/// of an earlier version gets the tables that came later. Throws StoreError for a file of another application or
/// another version (found, expected, what to do).
void prepare_schema(SQLite::Database& database, const std::filesystem::path& file, bool create);

/// Looks at the file's header, without SQLite (which takes a short file for an empty database, and overwrites it).
/// Throws StoreError when there is a file that is not ours. To be called while no connection is open.
void check_owner(const std::filesystem::path& file);

/// Removes results.sqlite and its journals. A file that is not ours is refused, not removed.
void forget_store(const std::filesystem::path& file);

/// Runs `work`, turning what SQLite reports into a StoreError that names the file, the cause and what to do.
void guarded(const std::filesystem::path& file, const SQLite::Database* database, const std::function<void()>& work);

/// Makes the view v_cases of these results: the columns of cases.csv (cases_table) over the finished cases, by the same
/// names. A query then needs neither the rows of axes and measures nor JSON. Truth values are 0 and 1. There is no view
/// of curves, nor of tables of numbers (impacts): their series are packed, and SQL cannot read doubles out of a blob.
void make_views(SQLite::Database& database, const StudyResults& results);

/// Gives cases of earlier programs their ids of today (runners/study/case_id.hpp), inside a transaction. Returns the
/// former ones.
std::vector<std::string> name_as_today(SQLite::Database& database);

// Cases of earlier versions of a study are kept in the store beside those that are asked for, by fingerprint. They have
// their measures, curves, tables and environment, and are seen by nobody until they are asked for again. Each call is
// made inside a transaction.

/// Moves these cases, of this environment, aside.
void set_aside(SQLite::Database& database, const std::vector<std::string>& ids, const Environment& environment);

/// Whether a case of this fingerprint is kept aside.
bool is_aside(SQLite::Database& database, const std::string& fingerprint);

/// Moves the case of this fingerprint back, to its place in the study's order. Returns the environment it ran in.
Environment bring_back(SQLite::Database& database, const std::string& fingerprint, int position);

/// The number of cases that are kept aside.
int count_aside(SQLite::Database& database);

}  // namespace ricochet
