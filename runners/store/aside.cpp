#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/store/checksums.hpp"
#include "runners/store/schema.hpp"
#include "runners/study/case_id.hpp"

namespace ricochet {
namespace {

using EnvironmentEntries = decltype(Environment::entries);

/// Executes `query`, whose parameters are these texts and numbers.
template <class... Values>
void execute(SQLite::Database& database, const std::string& query, const Values&... values) {
  SQLite::Statement statement(database, query);
  int index = 0;
  (statement.bind(++index, values), ...);
  statement.exec();
}

void copy_rows(SQLite::Database& database, const char* from, const std::string& key, const char* to,
               const std::string& new_key) {
  const auto copy = [&](const char* table, const char* columns) {
    execute(database,
            fmt::format("INSERT INTO {0}{2}(case_id, {3}) SELECT ?, {3} FROM {1}{2} WHERE case_id = ?", to, from, table,
                        columns),
            new_key, key);
  };
  for (const auto& [table, columns] : kRowsOfCases) copy(table, columns);
  copy("sums", "sum, place");
}

// Of the ids of earlier programs.
std::string ten_digits() {
  std::string pattern;
  for (int k = 0; k < 10; ++k) pattern += "[0-9a-f]";
  return pattern;
}

/// The key under which an environment is kept; cases that ran together share it.
std::int64_t keep(SQLite::Database& database, const Environment& environment) {
  const std::string entries = nlohmann::ordered_json(environment.entries)
                                  .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  execute(database, "INSERT OR IGNORE INTO aside_environments(entries) VALUES(?)", entries);
  SQLite::Statement find(database, "SELECT id FROM aside_environments WHERE entries = ?");
  find.bind(1, entries);
  find.executeStep();
  return find.getColumn(0).getInt64();
}

}  // namespace

std::vector<std::string> name_as_today(SQLite::Database& database) {
  const std::string pattern = ten_digits(), letter(1, case_letter);
  std::vector<std::string> former;
  SQLite::Statement find(database, "SELECT id FROM cases WHERE id GLOB ?");
  find.bind(1, pattern);
  while (find.executeStep()) former.push_back(find.getColumn(0).getString());
  find.reset();
  if (!former.empty()) {
    // Rows name their case: until all do, some name one that is not there.
    database.exec("PRAGMA defer_foreign_keys=ON");
    const auto name = [&](const char* table) {
      execute(database, fmt::format("UPDATE {} SET case_id = ? || case_id WHERE case_id GLOB ?", table), letter,
              pattern);
    };
    for (const auto& [table, columns] : kRowsOfCases) name(table);
    name("sums");
    execute(database, "UPDATE cases SET id = ? || id WHERE id GLOB ?", letter, pattern);
  }
  execute(database, "UPDATE begun SET case_id = ? || case_id WHERE case_id GLOB ?", letter, pattern);
  execute(database, "UPDATE aside_cases SET id = ? || id WHERE id GLOB ?", letter, pattern);
  return former;
}

void set_aside(SQLite::Database& database, const std::vector<std::string>& ids, const Environment& environment) {
  if (ids.empty()) return;
  const std::int64_t ran_in = keep(database, environment);
  for (const std::string& id : ids) {
    SQLite::Statement find(database, "SELECT fingerprint FROM cases WHERE id = ?");
    find.bind(1, id);
    find.executeStep();
    const std::string fingerprint = find.getColumn(0).getString();
    execute(database,
            fmt::format("INSERT INTO aside_cases(fingerprint, id, environment, {0}) SELECT fingerprint, id, ?, {0} "
                        "FROM cases WHERE id = ?",
                        kCaseColumns),
            ran_in, id);
    copy_rows(database, "", id, "aside_", fingerprint);
    execute(database, "DELETE FROM cases WHERE id = ?", id);
  }
}

bool is_aside(SQLite::Database& database, const std::string& fingerprint) {
  SQLite::Statement find(database, "SELECT 1 FROM aside_cases WHERE fingerprint = ?");
  find.bind(1, fingerprint);
  // What is no longer whole is computed again.
  return find.executeStep() && is_whole(database, "aside_", fingerprint);
}

Environment bring_back(SQLite::Database& database, const std::string& fingerprint, int position) {
  SQLite::Statement find(database,
                         "SELECT aside_cases.id, entries FROM aside_cases JOIN aside_environments "
                         "ON aside_environments.id = environment WHERE fingerprint = ?");
  find.bind(1, fingerprint);
  find.executeStep();
  const std::string id = find.getColumn(0).getString();
  const Environment environment{nlohmann::ordered_json::parse(find.getColumn(1).getString()).get<EnvironmentEntries>()};
  execute(database,
          fmt::format("INSERT INTO cases(position, fingerprint, id, {0}) SELECT ?, fingerprint, id, {0} "
                      "FROM aside_cases WHERE fingerprint = ?",
                      kCaseColumns),
          position, fingerprint);
  copy_rows(database, "aside_", fingerprint, "", id);
  find.reset();
  execute(database, "DELETE FROM aside_cases WHERE fingerprint = ?", fingerprint);
  database.exec("DELETE FROM aside_environments WHERE id NOT IN (SELECT environment FROM aside_cases)");
  return environment;
}

int count_aside(SQLite::Database& database) {
  return database.execAndGet("SELECT count(*) FROM aside_cases").getInt();
}

}  // namespace ricochet
