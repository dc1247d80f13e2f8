#include "runners/store/aside.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <utility>

namespace ricochet {
namespace {

using EnvironmentEntries = decltype(Environment::entries);

constexpr const char* kCaseColumns = "status, reason, steps, setup_seconds, run_seconds, operator, arithmetic";
// The tables of what belongs to a case: name, columns beside case_id.
constexpr std::pair<const char*, const char*> kRowsOfCases[] = {
    {"axes", "position, name, value"},
    {"measures", "position, name, value"},
    {"left_out", "position, item, reason"},
    {"notes", "position, note"},
    {"curves", "position, name, series"},
    {"case_tables", "position, name, content"},
    {"case_numbers", "position, part, name, exported, column_name, words, series"}};

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
  for (const auto& [table, columns] : kRowsOfCases)
    execute(database,
            fmt::format("INSERT INTO {0}{2}(case_id, {3}) SELECT ?, {3} FROM {1}{2} WHERE case_id = ?", to, from, table,
                        columns),
            new_key, key);
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
  return find.executeStep();
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
