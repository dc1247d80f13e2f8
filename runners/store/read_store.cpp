#include "runners/store/read_store.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "runners/store/atomic_file.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/number_rows.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/schema.hpp"
#include "runners/store/store.hpp"
#include "runners/study/case_id.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

/// Calls `row(record, statement)` for each row of these columns of `table`, in the order of `order`: of all cases, or
/// of the only one.
template <class Row>
void per_case(SQLite::Database& database, std::map<std::string, CaseRecord*>& cases, const char* columns,
              const char* table, const char* order, Row row) {
  const bool only = cases.size() == 1;
  SQLite::Statement statement(database, fmt::format("SELECT case_id, {} FROM {}{} ORDER BY case_id, {}", columns, table,
                                                    only ? " WHERE case_id = ?" : "", order));
  if (only) statement.bind(1, cases.begin()->first);
  while (statement.executeStep()) {
    const auto found = cases.find(statement.getColumn(0).getString());
    if (found != cases.end()) row(*found->second, statement);
  }
}

StudyPart part_of(const Json& value) {
  return {value.at(0).get<int>(), value.at(1).get<int>()};
}

void read_study(SQLite::Database& database, StudyResults& results) {
  SQLite::Statement statement(database, "SELECT key, value FROM study");
  while (statement.executeStep()) {
    const std::string key = statement.getColumn(0).getString();
    const Json value = Json::parse(statement.getColumn(1).getString());
    if (key == "name") results.name = value.get<std::string>();
    if (key == "question") results.question = value.get<std::string>();
    if (key == "kind") results.kind = value.get<std::string>();
    if (key == "resolved") results.study = value;
    if (key == "columns") results.columns = value.get<std::vector<std::string>>();
    if (key == "axes")
      for (const Json& axis : value)
        results.axes.push_back(
            {axis.at(0).get<std::string>(), axis.at(1).get<std::string>(), axis.at(2).get<std::string>()});
    if (key == "method_words") results.method_words = value.get<std::map<std::string, std::string>>();
    if (key == "expected_cases") results.expected_cases = value.get<int>();
    if (key == "part") results.part = part_of(value);
  }
}

constexpr const char* kStoredCase =
    "id, status, reason, steps, setup_seconds, run_seconds, operator, fingerprint, arithmetic";

CaseRecord case_of(SQLite::Statement& row) {
  CaseRecord record;
  record.id = row.getColumn(0).getString();
  record.status = row.getColumn(1).getString();
  record.reason = row.getColumn(2).getString();
  record.steps = row.getColumn(3).getInt64();
  record.setup_seconds = row.getColumn(4).getDouble();
  record.run_seconds = row.getColumn(5).getDouble();
  record.operator_name = row.getColumn(6).getString();
  record.partial = row.getColumn(7).getString().empty();
  record.arithmetic = row.getColumn(8).getString();
  return record;
}

Series series_of(SQLite::Database& database, const CaseRecord& record, std::vector<StoredPiece> pieces,
                 StoredSeries* later) {
  if (later && !record.partial) return later->series(std::move(pieces));
  std::vector<double> values;
  for (const StoredPiece& piece : pieces) {
    const std::vector<double> more = read_piece(database, piece);
    values.insert(values.end(), more.begin(), more.end());
  }
  return values;
}

std::size_t count_of_numbers(const SQLite::Column& bytes) {
  return static_cast<std::size_t>(bytes.getInt64()) / sizeof(double);
}

void read_curves(SQLite::Database& database, std::map<std::string, CaseRecord*>& cases, StoredSeries* later) {
  per_case(database, cases, "position, name, length(series)", "curves", "position",
           [&](CaseRecord& record, SQLite::Statement& row) {
             record.curve.names.push_back(row.getColumn(2).getString());
             record.curve.columns.push_back(series_of(database, record,
                                                      {{StoredPiece::Of::curves, record.id, row.getColumn(1).getInt(),
                                                        0, count_of_numbers(row.getColumn(3))}},
                                                      later));
           });
}

void read_numbers(SQLite::Database& database, std::map<std::string, CaseRecord*>& cases, StoredSeries* later) {
  std::map<CaseRecord*, std::vector<std::vector<std::vector<StoredPiece>>>> pieces;  // of each table, of each column
  per_case(database, cases, "position, part, name, exported, column_name, words, length(series)", "case_numbers",
           "position, part", [&](CaseRecord& record, SQLite::Statement& row) {
             auto& tables = pieces[&record];
             const auto part = static_cast<std::size_t>(row.getColumn(2).getInt());
             const std::string name = row.getColumn(3).getString();
             if (part == 0 && (record.numbers.empty() || record.numbers.back().name != name)) {
               NumberTable& first = record.numbers.emplace_back();
               first.name = name;
               first.exported = row.getColumn(4).getInt() != 0;
               tables.emplace_back();
             }
             NumberTable& table = record.numbers.back();
             if (part == table.columns.size()) {
               tables.back().emplace_back();
               table.columns.push_back({row.getColumn(5).getString(), "", ""});
               if (!row.getColumn(6).isNull())
                 table.words.emplace_back(table.columns.back().name,
                                          Json::parse(row.getColumn(6).getString()).get<std::vector<std::string>>());
             }
             tables.back()[part].push_back({StoredPiece::Of::case_numbers, record.id, row.getColumn(1).getInt(),
                                            static_cast<int>(part), count_of_numbers(row.getColumn(7))});
           });
  for (auto& [record, tables] : pieces)
    for (std::size_t t = 0; t < tables.size(); ++t)
      for (std::vector<StoredPiece>& column : tables[t])
        record->numbers[t].values.push_back(series_of(database, *record, std::move(column), later));
}

/// Reads what belongs to these cases.
void read_rows(SQLite::Database& database, std::map<std::string, CaseRecord*>& cases, StoredSeries* later) {
  using Statement = SQLite::Statement;
  per_case(database, cases, "name, value", "axes", "position", [](CaseRecord& record, Statement& row) {
    record.axes.emplace_back(row.getColumn(1).getString(), Json::parse(row.getColumn(2).getString()));
  });
  per_case(database, cases, "name, value", "measures", "position", [](CaseRecord& record, Statement& row) {
    record.measures.emplace_back(row.getColumn(1).getString(), row.getColumn(2).getDouble());
  });
  per_case(database, cases, "item, reason", "left_out", "position", [](CaseRecord& record, Statement& row) {
    record.left_out.emplace_back(row.getColumn(1).getString(), row.getColumn(2).getString());
  });
  per_case(database, cases, "note", "notes", "position",
           [](CaseRecord& record, Statement& row) { record.notes.push_back(row.getColumn(1).getString()); });
  read_curves(database, cases, later);
  per_case(database, cases, "name, content", "case_tables", "position", [](CaseRecord& record, Statement& row) {
    // What the columns mean is not stored: the kind of study declares it.
    const Json content = Json::parse(row.getColumn(2).getString());
    const std::string name = row.getColumn(1).getString();
    if (record.tables.empty() || record.tables.back().name != name) {
      Table& first = record.tables.emplace_back();
      first.name = name;
      first.columns = named_columns(content.at("columns").get<std::vector<std::string>>());
    }
    Table& table = record.tables.back();
    for (const Json& cells : content.at("rows")) {
      Row& one = table.rows.emplace_back();
      for (const Json& cell : cells) one.push_back(cell_of(cell));
    }
  });
  read_numbers(database, cases, later);
}

}  // namespace

std::optional<StudyPart> read_part(SQLite::Database& database) {
  SQLite::Statement part(database, "SELECT value FROM study WHERE key = 'part'");
  if (part.executeStep()) return part_of(Json::parse(part.getColumn(0).getString()));
  // Stores of programs that knew no parts.
  SQLite::Statement name(database, "SELECT 1 FROM study WHERE key = 'name'");
  return name.executeStep() ? std::optional(StudyPart{}) : std::nullopt;
}

Environment read_environment(SQLite::Database& database) {
  Environment environment;
  SQLite::Statement rows(database, "SELECT name, value FROM environment ORDER BY position");
  while (rows.executeStep())
    environment.entries.emplace_back(rows.getColumn(0).getString(), rows.getColumn(1).getString());
  return environment;
}

StudyResults read_tables(SQLite::Database& database) {
  StudyResults results;
  SQLite::Transaction transaction(database);
  read_study(database, results);
  SQLite::Statement rows(database, fmt::format("SELECT {} FROM cases ORDER BY position", kStoredCase));
  while (rows.executeStep()) results.cases.push_back(case_of(rows));
  std::map<std::string, CaseRecord*> cases;
  for (CaseRecord& record : results.cases) cases[record.id] = &record;
  const auto later = std::make_shared<StoredSeries>(database.getFilename());
  if (!cases.empty()) read_rows(database, cases, later.get());
  for (CaseRecord& record : results.cases) record.id = id_of_today(record.id);
  results.environment = read_environment(database);
  tell_arithmetics(results);
  return results;
}

StudyResults read_head(SQLite::Database& database) {
  StudyResults results;
  read_study(database, results);
  results.environment = read_environment(database);
  return results;
}

std::optional<CaseRecord> read_case(SQLite::Database& database, const std::string& id) {
  SQLite::Statement row(database, fmt::format("SELECT {} FROM cases WHERE id = ? OR id = ?", kStoredCase));
  row.bind(1, id);
  row.bind(2, former_id(id));
  if (!row.executeStep()) return std::nullopt;
  CaseRecord record = case_of(row);
  std::map<std::string, CaseRecord*> only = {{record.id, &record}};
  read_rows(database, only, nullptr);
  record.id = id_of_today(record.id);
  return record;
}

std::string find_motion(SQLite::Database& database, const std::string& whole_key) {
  SQLite::Statement find(database, "SELECT content FROM motions WHERE key = ?");
  find.bind(1, whole_key);
  if (!find.executeStep()) return "";
  const SQLite::Column blob = find.getColumn(0);
  return {static_cast<const char*>(blob.getBlob()), static_cast<std::size_t>(blob.getBytes())};
}

std::unique_ptr<SQLite::Database> open_store(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "results.sqlite";
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw StoreError(fmt::format("{}: there is no results.sqlite here{}; expected the folder of a study that was run",
                                 folder.string(), error ? " (" + error.message() + ")" : ""));
  std::unique_ptr<SQLite::Database> database;
  guarded(file, nullptr, [&] {
    // Opened for writing where possible: a store left by a killed process is rolled back by its first reader.
    constexpr int wait_ms = 10000;
    database = std::make_unique<SQLite::Database>(file, SQLite::OPEN_READWRITE, wait_ms);
    prepare_schema(*database, file, false);
  });
  return database;
}

void with_store(const std::filesystem::path& folder, const std::function<void(SQLite::Database&)>& use) {
  const auto database = open_store(folder);
  guarded(folder / "results.sqlite", database.get(), [&] { use(*database); });
}

StudyResults read_store(const std::filesystem::path& folder) {
  StudyResults results;
  with_store(folder, [&](SQLite::Database& database) { results = read_tables(database); });
  return results;
}

std::string read_motion(const std::filesystem::path& folder, const std::string& key, const std::string& arithmetic) {
  std::string content;
  with_store(folder, [&](SQLite::Database& database) { content = find_motion(database, motion_key(arithmetic, key)); });
  return content;
}

StoreReader::StoreReader(const std::filesystem::path& folder)
    : file_(folder / "results.sqlite"), database_(open_store(folder)) {}

StudyResults StoreReader::head() const {
  StudyResults head;
  guarded(file_, database_.get(), [&] { head = read_head(*database_); });
  return head;
}

std::vector<StoreReader::Finished> StoreReader::finished() const {
  std::vector<Finished> found;
  guarded(file_, database_.get(), [&] {
    SQLite::Statement rows(*database_,
                           "SELECT id, fingerprint, status, arithmetic FROM cases WHERE fingerprint != '' "
                           "ORDER BY position");
    while (rows.executeStep())
      found.push_back({id_of_today(rows.getColumn(0).getString()), rows.getColumn(1).getString(),
                       rows.getColumn(2).getString(), rows.getColumn(3).getString()});
  });
  return found;
}

CaseRecord StoreReader::read(const std::string& id) const {
  std::optional<CaseRecord> found;
  guarded(file_, database_.get(), [&] { found = read_case(*database_, id); });
  if (!found) throw StoreError(fmt::format("{}: the case {} is no longer there", file_.string(), id));
  return std::move(*found);
}

std::vector<std::string> StoreReader::motion_keys(const std::string& arithmetic) const {
  std::vector<std::string> found;
  const std::string prefix = motion_key(arithmetic, "");
  guarded(file_, database_.get(), [&] {
    SQLite::Statement rows(*database_, "SELECT key FROM motions ORDER BY key");
    while (rows.executeStep())
      if (const std::string key = rows.getColumn(0).getString(); key.starts_with(prefix))
        found.push_back(key.substr(prefix.size()));
  });
  return found;
}

std::string StoreReader::motion(const std::string& key, const std::string& arithmetic) const {
  std::string content;
  guarded(file_, database_.get(), [&] { content = find_motion(*database_, motion_key(arithmetic, key)); });
  return content;
}

RunStatus read_status(const std::filesystem::path& folder) {
  RunStatus status;
  with_store(folder, [&](SQLite::Database& database) {
    SQLite::Transaction transaction(database);
    SQLite::Statement study(
        database, "SELECT key, value FROM study WHERE key NOT IN ('resolved', 'columns', 'axes', 'method_words')");
    while (study.executeStep()) {
      const std::string key = study.getColumn(0).getString();
      const auto value = nlohmann::json::parse(study.getColumn(1).getString());
      if (key == "name") status.name = value.get<std::string>();
      if (key == "question") status.question = value.get<std::string>();
      if (key == "kind") status.kind = value.get<std::string>();
      if (key == "expected_cases") status.expected = value.get<int>();
      if (key == "progress") {
        status.progress = value.at("text").get<std::string>();
        status.heard = value.at("at").get<std::string>();
      }
    }
    status.part = read_part(database).value_or(StudyPart{});
    SQLite::Statement rows(database, "SELECT status, fingerprint = '', count(*) FROM cases GROUP BY 1, 2");
    while (rows.executeStep()) {
      const int count = rows.getColumn(2).getInt();
      (rows.getColumn(1).getInt() != 0 ? status.partial : status.rows[rows.getColumn(0).getString()]) += count;
    }
    SQLite::Statement begun(database, "SELECT case_id, stage, since FROM begun ORDER BY since, case_id");
    while (begun.executeStep())
      status.under_way.push_back({id_of_today(begun.getColumn(0).getString()), begun.getColumn(1).getString(),
                                  begun.getColumn(2).getString()});
    SQLite::Statement epoch(database, "SELECT run FROM epoch");
    if (epoch.executeStep()) status.run = RunIdentity::from_json(epoch.getColumn(0).getString());
  });
  std::error_code error;
  const auto written = std::filesystem::last_write_time(folder / "results.sqlite", error);
  if (!error)
    status.silent =
        std::max(0.0, std::chrono::duration<double>(std::filesystem::file_time_type::clock::now() - written).count());
  return status;
}

}  // namespace ricochet
