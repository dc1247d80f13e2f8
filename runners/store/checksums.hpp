#pragma once
#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "runners/store/record.hpp"
#include "runners/store/statements.hpp"

namespace ricochet {

/// A checksum of bytes: 64 bits. Any single word of eight bytes that changes changes it. It finds damage, and keeps no
/// forger out.
class Checksum {
 public:
  void add(std::string_view bytes);
  void add(std::uint64_t word);
  /// The columns of a row from this one on, with their types.
  void add(SQLite::Statement& row, int first);
  /// 16 hexadecimal digits.
  std::string text() const;

 private:
  std::uint64_t state_ = 0x9E3779B97F4A7C15U;
};

std::string checksum_of(std::string_view bytes);

// Each case of a store has the checksum of its row and of all that belongs to it, and one of that and its place. A
// prefix says which: "" of cases, "aside_" of those kept aside, whose key is their fingerprint.

/// States the checksums of a case that was written. Inside a transaction.
void seal_case(Statements& prepared, const std::string& prefix, const std::string& key);
/// The same for every case.
void seal_cases(SQLite::Database& database, const std::string& prefix);
/// States the checksum of its place anew.
void seal_place(Statements& prepared, const std::string& id);

/// Checksums of all cases, of the rows that queries give them: those of rows_query, each row of a case after the other.
class CaseSums {
 public:
  CaseSums() = default;
  CaseSums(const CaseSums&) = delete;
  CaseSums& operator=(const CaseSums&) = delete;

  /// A row of the case itself (`of_case`), or of what belongs to it. The key comes first.
  void add(SQLite::Statement& row, bool of_case);
  /// By key.
  std::map<std::string, std::string> texts() const;

 private:
  std::map<std::string, Checksum> sums_;
  std::map<std::string, Checksum>::iterator last_ = sums_.end();
};

/// The query of the cases' own rows (`table` = "cases"), or of a table of kRowsOfCases, in the order of the checksums.
std::string rows_query(const std::string& prefix, const std::string& table, const std::string& columns, bool only);

/// The cases of which these checksums, or places, are not those that were stated; none in a store that states none.
Damage damaged_cases(SQLite::Database& database, const std::map<std::string, std::string>& sums);

/// Whether a case has the checksums that were stated, its rows and its place.
bool is_whole(SQLite::Database& database, const std::string& prefix, const std::string& key);

/// Compares all cases with their checksums.
Damage find_damage(SQLite::Database& database);
/// "results.sqlite: case c0123456789 and 2 more are damaged: …", with what to do.
std::string damage_text(const std::filesystem::path& file, const Damage& damage);

/// Whether an id can be that of a case: letters, digits and hyphens. Ids become names of files.
bool is_case_id(std::string_view id);
/// Whether a name can be that of a table: small letters, digits, _ and -. Names become those of files.
bool is_table_name(std::string_view name);

// What the table `study` holds, and the environment, have checksums by key.

/// States them.
void seal_study(SQLite::Database& database);
/// The keys whose values are not those that were stored, "environment" among them.
std::set<std::string> damaged_keys(SQLite::Database& database);

}  // namespace ricochet
