#include "runners/store/checksums.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Exception.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <ricochet/contract/errors.hpp>
#include <vector>

#include "runners/store/schema.hpp"
#include "runners/study/case_id.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

// The key of what states the others, and what changes too often to have one.
constexpr const char* sealed_key = "checksums";
constexpr const char* progress_key = "progress";
constexpr const char* environment_key = "environment";

std::string key_of(const std::string& prefix) {
  return prefix.empty() ? "id" : "fingerprint";
}

/// Row and children of the cases, a query each, the key first; `only`: of the case that is bound.
std::vector<std::string> queries(const std::string& prefix, bool only) {
  std::vector<std::string> out = {rows_query(prefix, "cases", kCaseColumns, only)};
  for (const auto& [table, columns] : kRowsOfCases) out.push_back(rows_query(prefix, table, columns, only));
  return out;
}

/// A row of such a query. Ids are taken as those of today, which programs give to earlier ones.
void add_row(SQLite::Statement& row, bool of_case, Checksum& sum) {
  if (!of_case) return sum.add(row, 1);
  sum.add(id_of_today(row.getColumn(1).getString()));
  sum.add(row, 2);
}

std::string place_sum(const std::string& sum, std::int64_t position) {
  Checksum place;
  place.add(sum);
  place.add(static_cast<std::uint64_t>(position));
  return place.text();
}

std::string sum_of(Statements& prepared, const std::string& prefix, const std::string& key) {
  Checksum sum;
  bool of_case = true;
  for (const std::string& query : queries(prefix, true)) {
    SQLite::Statement& rows = prepared.of(query);
    rows.reset();
    rows.bind(1, key);
    while (rows.executeStep()) add_row(rows, of_case, sum);
    rows.reset();
    of_case = false;
  }
  return sum.text();
}

std::map<std::string, std::string> sums_of_all(SQLite::Database& database, const std::string& prefix) {
  CaseSums sums;
  bool of_case = true;
  for (const std::string& query : queries(prefix, false)) {
    SQLite::Statement rows(database, query);
    while (rows.executeStep()) sums.add(rows, of_case);
    of_case = false;
  }
  return sums.texts();
}

std::int64_t position_of(Statements& prepared, const std::string& id) {
  SQLite::Statement& find = prepared.of("SELECT position FROM cases WHERE id = ?");
  find.reset();
  find.bind(1, id);
  const std::int64_t position = find.executeStep() ? find.getColumn(0).getInt64() : -1;
  find.reset();
  return position;
}

void state(Statements& prepared, const std::string& prefix, const std::string& key, const std::string& sum,
           std::int64_t position) {
  SQLite::Statement& add =
      prepared.of(fmt::format("INSERT OR REPLACE INTO {}sums(case_id, sum, place) VALUES(?, ?, ?)", prefix));
  add.reset();
  add.bind(1, key);
  add.bind(2, sum);
  add.bind(3, place_sum(sum, position));
  add.exec();
}

bool has_table(SQLite::Database& database, const std::string& name) {
  SQLite::Statement find(database, "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?");
  find.bind(1, name);
  return find.executeStep();
}

/// What was stated of a case.
struct Seal {
  std::string sum, place;
};

bool fits(const Seal& stated, const std::string& sum, std::int64_t position) {
  return stated.sum == sum && stated.place == place_sum(sum, position);
}

/// The checksum of each value of the study, and of the environment, by key.
std::map<std::string, std::string> sums_of_study(SQLite::Database& database) {
  std::map<std::string, std::string> sums;
  SQLite::Statement values(database, "SELECT key, value FROM study");
  while (values.executeStep()) {
    const std::string key = values.getColumn(0).getString();
    if (key != sealed_key && key != progress_key) sums[key] = checksum_of(values.getColumn(1).getString());
  }
  Checksum environment;
  SQLite::Statement entries(database, "SELECT position, name, value FROM environment ORDER BY position");
  while (entries.executeStep()) environment.add(entries, 0);
  sums[environment_key] = environment.text();
  return sums;
}

}  // namespace

void Checksum::add(std::uint64_t word) {
  // One to one in either argument.
  state_ = std::rotl((state_ ^ word) * 0xD6E8FEB86659FD93U, 29) + 0xA0761D6478BD642FU;
}

void Checksum::add(std::string_view bytes) {
  add(std::uint64_t{bytes.size()});
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    add(word);
  }
}

void Checksum::add(SQLite::Statement& row, int first) {
  for (int c = first; c < row.getColumnCount(); ++c) {
    const SQLite::Column column = row.getColumn(c);
    add(static_cast<std::uint64_t>(column.getType()));
    if (column.isInteger()) {
      add(static_cast<std::uint64_t>(column.getInt64()));
    } else if (column.isFloat()) {
      add(std::bit_cast<std::uint64_t>(column.getDouble()));
    } else if (!column.isNull()) {
      const void* bytes = column.getBlob();
      add(std::string_view(static_cast<const char*>(bytes), bytes ? static_cast<std::size_t>(column.getBytes()) : 0));
    }
  }
}

std::string Checksum::text() const {
  return fmt::format("{:016x}", state_ ^ (state_ >> 32U));
}

std::string checksum_of(std::string_view bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.text();
}

void seal_case(Statements& prepared, const std::string& prefix, const std::string& key) {
  state(prepared, prefix, key, sum_of(prepared, prefix, key), prefix.empty() ? position_of(prepared, key) : -1);
}

void seal_cases(SQLite::Database& database, const std::string& prefix) {
  Statements prepared(database);
  for (const auto& [key, sum] : sums_of_all(database, prefix))
    state(prepared, prefix, key, sum, prefix.empty() ? position_of(prepared, key) : -1);
}

void seal_place(Statements& prepared, const std::string& id) {
  SQLite::Statement& find = prepared.of("SELECT sum FROM sums WHERE case_id = ?");
  find.reset();
  find.bind(1, id);
  const std::string sum = find.executeStep() ? find.getColumn(0).getString() : "";
  find.reset();
  if (!sum.empty()) state(prepared, "", id, sum, position_of(prepared, id));
}

bool is_whole(SQLite::Database& database, const std::string& prefix, const std::string& key) try {
  if (!has_table(database, prefix + "sums")) return true;
  Statements prepared(database);
  SQLite::Statement stated(database, fmt::format("SELECT sum, place FROM {}sums WHERE case_id = ?", prefix));
  stated.bind(1, key);
  if (!stated.executeStep()) return false;
  const Seal seal{stated.getColumn(0).getString(), stated.getColumn(1).getString()};
  const std::string sum = sum_of(prepared, prefix, key);
  // What is kept aside has no place.
  return prefix.empty() ? fits(seal, sum, position_of(prepared, key)) : seal.sum == sum;
} catch (const SQLite::Exception&) {
  return false;
}

void CaseSums::add(SQLite::Statement& row, bool of_case) {
  const SQLite::Column key = row.getColumn(0);
  if (last_ == sums_.end() || last_->first != key.getText())
    last_ = of_case ? sums_.try_emplace(key.getString()).first : sums_.find(key.getString());
  if (last_ != sums_.end()) add_row(row, of_case, last_->second);
}

std::map<std::string, std::string> CaseSums::texts() const {
  std::map<std::string, std::string> out;
  for (const auto& [key, sum] : sums_) out[key] = sum.text();
  return out;
}

std::string rows_query(const std::string& prefix, const std::string& table, const std::string& columns, bool only) {
  const bool of_case = table == "cases", parts = columns.starts_with("position, part");
  const std::string key = of_case ? key_of(prefix) : "case_id";
  return fmt::format("SELECT {0}, {1}{2} FROM {3}{4}{5}{6}", key, of_case ? "id, fingerprint, " : "", columns, prefix,
                     table, only ? fmt::format(" WHERE {} = ?", key) : "",
                     of_case ? "" : fmt::format(" ORDER BY case_id, position{}", parts ? ", part" : ""));
}

namespace {

/// What was stated of the cases, and their places.
struct Stated {
  std::map<std::string, Seal> seals;
  std::map<std::string, std::int64_t> positions;
  bool pages = false;  ///< some of it cannot be read
};

Stated read_stated(SQLite::Database& database) {
  Stated stated;
  const auto each = [&](const char* query, const auto& take) {
    try {
      SQLite::Statement rows(database, query);
      while (rows.executeStep()) take(rows);
    } catch (const SQLite::Exception&) {
      stated.pages = true;
    }
  };
  each("SELECT case_id, sum, place FROM sums", [&](SQLite::Statement& row) {
    stated.seals[row.getColumn(0).getString()] = {row.getColumn(1).getString(), row.getColumn(2).getString()};
  });
  each("SELECT id, position FROM cases",
       [&](SQLite::Statement& row) { stated.positions[row.getColumn(0).getString()] = row.getColumn(1).getInt64(); });
  return stated;
}

/// The cases that are stated and are not there, and those that are not whole.
std::set<std::string> damaged_of(const Stated& stated, const std::function<bool(const std::string& id)>& whole) {
  std::set<std::string> damaged;
  for (const auto& [id, ignored] : stated.seals)
    if (!stated.positions.contains(id)) damaged.insert(id);
  for (const auto& [id, ignored] : stated.positions)
    if (!whole(id)) damaged.insert(id);
  return damaged;
}

bool fits(const Stated& stated, const std::map<std::string, std::string>& sums, const std::string& id) {
  const auto seal = stated.seals.find(id);
  const auto sum = sums.find(id);
  return seal != stated.seals.end() && sum != sums.end() && fits(seal->second, sum->second, stated.positions.at(id));
}

}  // namespace

Damage damaged_cases(SQLite::Database& database, const std::map<std::string, std::string>& sums) {
  Damage damage;
  if (!has_table(database, "sums")) return damage;
  const Stated stated = read_stated(database);
  damage.pages = stated.pages;
  damage.cases = damaged_of(stated, [&](const std::string& id) { return fits(stated, sums, id); });
  return damage;
}

Damage find_damage(SQLite::Database& database) {
  Damage damage;
  if (!has_table(database, "sums")) return damage;
  const Stated stated = read_stated(database);
  damage.pages = stated.pages;
  std::map<std::string, std::string> sums;
  if (!damage.pages) try {
      sums = sums_of_all(database, "");
    } catch (const SQLite::Exception&) {
      damage.pages = true;
    }
  damage.cases = damaged_of(stated, [&](const std::string& id) {
    return damage.pages ? is_whole(database, "", id) : fits(stated, sums, id);
  });
  return damage;
}

std::string damage_text(const std::filesystem::path& file, const Damage& damage) {
  constexpr std::size_t named = 8;
  std::vector<std::string> parts;
  for (const std::string& id : damage.cases)
    if (parts.size() < named) parts.push_back("case " + plain_text(shortened(id)));
  if (damage.cases.size() > parts.size())
    parts.push_back(fmt::format("{} more cases", damage.cases.size() - parts.size()));
  if (damage.environment) parts.emplace_back("the environment");
  if (damage.pages) parts.emplace_back("pages of the file");
  return fmt::format("{}: this store is damaged in {}; {}", file.string(), fmt::join(parts, ", "),
                     damage.pages ? fmt::format("`ricochet merge {} --out NEW` keeps the cases that are whole",
                                                file.parent_path().string())
                                  : "`ricochet run STUDY.json` computes that again, and keeps the rest");
}

bool is_case_id(std::string_view id) {
  constexpr std::size_t longest = 64;
  return !id.empty() && id.size() <= longest && id.front() != '-' && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  });
}

bool is_table_name(std::string_view name) {
  constexpr std::size_t longest = 64;
  return !name.empty() && name.size() <= longest && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

void seal_study(SQLite::Database& database) {
  SQLite::Statement add(database, "INSERT OR REPLACE INTO study(key, value) VALUES(?, ?)");
  add.bind(1, sealed_key);
  add.bind(2, nlohmann::ordered_json(sums_of_study(database)).dump());
  add.exec();
}

std::set<std::string> damaged_keys(SQLite::Database& database) {
  std::set<std::string> damaged;
  SQLite::Statement find(database, "SELECT value FROM study WHERE key = ?");
  find.bind(1, sealed_key);
  if (!find.executeStep()) return damaged;  // of programs that knew none
  const auto stated = nlohmann::ordered_json::parse(find.getColumn(0).getString(), nullptr, false);
  if (!stated.is_object()) return {sealed_key};
  std::map<std::string, std::string> sums = sums_of_study(database);
  for (const auto& [key, sum] : stated.items())
    if (const auto found = sums.find(key); found == sums.end() || sum != found->second) damaged.insert(key);
  for (const auto& [key, ignored] : sums)
    if (!stated.contains(key)) damaged.insert(key);
  return damaged;
}

}  // namespace ricochet
