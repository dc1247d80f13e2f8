#include "runners/store/read_store.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/number_rows.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/schema.hpp"
#include "runners/store/store.hpp"
#include "runners/study/case_id.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

/// The cases that are read, and those of them whose rows make no sense: a store of an earlier program has no checksums.
struct ReadCases {
  std::map<std::string, CaseRecord*> records;
  CaseSums* sums = nullptr;  ///< are made of the rows
  std::set<std::string> damaged = {};
  std::map<std::vector<std::string>, Columns> columns = {};  // by their names: most cases have the same

  Columns named(const std::vector<std::string>& names) {
    const auto [place, added] = columns.try_emplace(names);
    if (added) place->second = named_columns(names);
    return place->second;
  }
};

/// A text of a column, as it may be shown.
std::string text_in(const SQLite::Column& column) {
  return plain_text(column.getString());
}

Json plain(const Json& value) {
  if (value.is_string()) return plain_text(value.get_ref<const std::string&>());
  if (value.is_array()) {
    Json out = Json::array();
    for (const Json& one : value) out.push_back(plain(one));
    return out;
  }
  if (!value.is_object()) return value;
  Json out = Json::object();
  for (const auto& [key, one] : value.items()) out[plain_text(key)] = plain(one);
  return out;
}

/// A JSON value of a column, its texts as they may be shown. Throws Json::exception.
Json json_in(const SQLite::Column& column) {
  const std::string text = column.getString();
  Json value = Json::parse(text);
  return is_plain(text) && text.find("\\u") == std::string::npos ? value : plain(value);
}

/// What a row says cannot be.
struct BadRow : std::runtime_error {
  BadRow() : std::runtime_error("a row that cannot be") {}
};

// What is short is read with its row: to ask for it later costs more than its numbers.
constexpr int read_bytes = 1024;

/// The columns of a table of kRowsOfCases. Of a series that no checksum needs, its bytes and, where short, its numbers.
std::string columns_of(const char* table, bool summed) {
  const auto* const found = std::find_if(std::begin(kRowsOfCases), std::end(kRowsOfCases),
                                         [&](const auto& one) { return std::string_view(one.first) == table; });
  std::string columns = found->second;
  constexpr std::string_view series = "series";
  if (!summed && columns.ends_with(series)) {
    columns.resize(columns.size() - series.size());
    columns += fmt::format("length(series), CASE WHEN length(series) <= {} THEN series END", read_bytes);
  }
  return columns;
}

/// Calls `row(record, statement)` for each row of `table`, in its order: of all cases, or of the only one. The case's
/// id is column 0, then come the columns of kRowsOfCases.
template <class Row>
void per_case(SQLite::Database& database, ReadCases& cases, const char* table, Row row) {
  const bool only = cases.records.size() == 1 && !cases.sums;
  SQLite::Statement statement(database, rows_query("", table, columns_of(table, cases.sums), only));
  if (only) statement.bind(1, cases.records.begin()->first);
  while (statement.executeStep()) {
    if (cases.sums) cases.sums->add(statement, false);
    const auto found = cases.records.find(statement.getColumn(0).getString());
    if (found == cases.records.end()) continue;
    try {
      row(*found->second, statement);
    } catch (const BadRow&) {
      cases.damaged.insert(found->first);
    } catch (const Json::exception&) {
      cases.damaged.insert(found->first);
    }
  }
}

StudyPart part_of(const Json& value) {
  return {value.at(0).get<int>(), value.at(1).get<int>()};
}

void read_study(SQLite::Database& database, StudyResults& results) {
  std::set<std::string> unsure = damaged_keys(database);
  results.damage.environment = unsure.erase("environment") > 0;
  if (!unsure.empty())
    throw StoreError(
        fmt::format("{}: what it says of the study is damaged ({}); `ricochet run STUDY.json` writes that "
                    "again, and keeps the cases",
                    database.getFilename(), plain_text(fmt::format("{}", fmt::join(unsure, ", ")))));
  SQLite::Statement statement(database, "SELECT key, value FROM study");
  while (statement.executeStep()) {
    const std::string key = statement.getColumn(0).getString();
    const Json value = json_in(statement.getColumn(1));
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

// Null for a case of another id or status than a case can have: what is damaged. The row is that of rows_query.
std::optional<CaseRecord> case_of(SQLite::Statement& row) {
  const auto status = of_word<Status>(row.getColumn(3).getString());
  CaseRecord record;
  record.id = row.getColumn(1).getString();
  if (!status || !is_case_id(record.id)) return std::nullopt;
  record.status = *status;
  record.partial = row.getColumn(2).getString().empty();
  if (std::string reason = text_in(row.getColumn(4)); !reason.empty()) record.reasons = {std::move(reason)};
  record.steps = row.getColumn(5).getInt64();
  record.setup_seconds = row.getColumn(6).getDouble();
  record.run_seconds = row.getColumn(7).getDouble();
  record.operator_name = text_in(row.getColumn(8));
  record.arithmetic = text_in(row.getColumn(9));
  return record;
}

/// The cases in the study's order, and the ids of those that can be none.
void read_cases(SQLite::Database& database, CaseSums* sums, StudyResults& results) {
  SQLite::Statement rows(database, rows_query("", "cases", kCaseColumns, false) + " ORDER BY position");
  while (rows.executeStep()) {
    if (sums) sums->add(rows, true);
    if (auto record = case_of(rows))
      results.cases.push_back(std::move(*record));
    else
      results.damage.cases.insert(rows.getColumn(0).getString());
  }
}

Series series_of(SQLite::Database& database, const CaseRecord& record, std::vector<StoredPiece> pieces,
                 StoredSeries* later) {
  if (pieces.size() == 1 && pieces.front().numbers) return std::move(*pieces.front().numbers);
  if (later && !record.partial) return later->series(std::move(pieces));
  std::vector<double> values;
  for (const StoredPiece& piece : pieces) {
    const std::vector<double> more = read_piece(database, piece);
    values.insert(values.end(), more.begin(), more.end());
  }
  return values;
}

// The piece whose series, or whose length and numbers, stand from this column on.
StoredPiece piece_of(StoredPiece::Of of, const CaseRecord& record, int position, int part, SQLite::Statement& row,
                     int column) {
  const SQLite::Column first = row.getColumn(column), last = row.getColumn(row.getColumnCount() - 1);
  const bool whole = column + 1 == row.getColumnCount();
  const std::int64_t bytes = whole ? first.getBytes() : first.getInt64();
  StoredPiece piece{of, record.id, position, part, static_cast<std::size_t>(bytes) / sizeof(double)};
  if (!last.isNull() && bytes <= read_bytes) piece.numbers = doubles_of(last);
  return piece;
}

void read_curves(SQLite::Database& database, ReadCases& cases, StoredSeries* later) {
  per_case(database, cases, "curves", [&](CaseRecord& record, SQLite::Statement& row) {
    record.curve.names.push_back(text_in(row.getColumn(2)));
    record.curve.columns.push_back(series_of(
        database, record, {piece_of(StoredPiece::Of::curves, record, row.getColumn(1).getInt(), 0, row, 3)}, later));
  });
}

/// The columns of one table of numbers while its pieces are read.
struct ReadColumns {
  std::vector<std::string> names;
  std::vector<std::vector<StoredPiece>> pieces;  // of each column
};

void read_numbers(SQLite::Database& database, ReadCases& cases, StoredSeries* later) {
  CaseRecord* of = nullptr;
  std::vector<ReadColumns> read;  // of each of its tables
  const auto end_case = [&] {
    for (std::size_t t = 0; t < read.size(); ++t) {
      NumberTable& table = of->numbers[t];
      table.columns = cases.named(read[t].names);
      for (std::vector<StoredPiece>& column : read[t].pieces) {
        // A row that made no sense left a name without numbers.
        if (column.empty()) cases.damaged.insert(of->id);
        table.values.push_back(column.empty() ? Series(std::vector<double>())
                                              : series_of(database, *of, std::move(column), later));
      }
      // A piece that is lost: the columns of a table are equally long.
      for (const Series& column : table.values)
        if (table.exported && column.size() != table.rows()) cases.damaged.insert(of->id);
    }
    read.clear();
  };
  per_case(database, cases, "case_numbers", [&](CaseRecord& record, SQLite::Statement& row) {
    if (of != &record) {
      end_case();
      of = &record;
    }
    const int number = row.getColumn(2).getInt();
    const auto part = static_cast<std::size_t>(number);
    const std::string name = row.getColumn(3).getString();
    const std::size_t known = read.empty() ? 0 : read.back().names.size();
    const bool same = known > 0 && record.numbers.back().name == name;
    if (number < 0 || (part > 0 && (!same || part > known)) || !is_table_name(name)) throw BadRow();
    if (part == 0 && !same) {
      NumberTable& first = record.numbers.emplace_back();
      first.name = name;
      first.exported = row.getColumn(4).getInt() != 0;
      read.emplace_back();
    }
    if (part == read.back().names.size()) {
      read.back().pieces.emplace_back();
      read.back().names.push_back(text_in(row.getColumn(5)));
      if (!row.getColumn(6).isNull())
        record.numbers.back().words.emplace_back(read.back().names.back(),
                                                 json_in(row.getColumn(6)).get<std::vector<std::string>>());
    }
    read.back().pieces[part].push_back(
        piece_of(StoredPiece::Of::case_numbers, record, row.getColumn(1).getInt(), number, row, 7));
  });
  end_case();
}

/// A text with the places of its numbers, [[begin, size], …].
Said said_in(const SQLite::Column& stored, const Json& marks) {
  Said out = text_in(stored);
  std::size_t end = 0;
  for (const Json& mark : marks) {
    const auto begin = mark.at(0).get<std::size_t>(), size = mark.at(1).get<std::size_t>();
    if (begin < end || size > out.text.size() || begin > out.text.size() - size) throw BadRow();
    out.marks.push_back({begin, size});
    end = begin + size;
  }
  return out;
}

/// Reads what belongs to these cases. Checksums ask for the order of kRowsOfCases.
void read_rows(SQLite::Database& database, ReadCases& cases, StoredSeries* later) {
  using Statement = SQLite::Statement;
  per_case(database, cases, "axes", [](CaseRecord& record, Statement& row) {
    record.axes.emplace_back(text_in(row.getColumn(2)), json_in(row.getColumn(3)));
  });
  per_case(database, cases, "measures", [](CaseRecord& record, Statement& row) {
    record.measures.emplace_back(text_in(row.getColumn(2)), row.getColumn(3).getDouble());
  });
  per_case(database, cases, "left_out", [](CaseRecord& record, Statement& row) {
    record.left_out.emplace_back(text_in(row.getColumn(2)), text_in(row.getColumn(3)));
  });
  per_case(database, cases, "notes",
           [](CaseRecord& record, Statement& row) { record.notes.push_back(text_in(row.getColumn(2))); });
  per_case(database, cases, "reasons", [](CaseRecord& record, Statement& row) {
    if (row.getColumn(1).getInt() == 0) record.reasons.clear();
    record.excluded = row.getColumn(2).getInt() != 0;
    record.reasons.push_back(said_in(row.getColumn(3), json_in(row.getColumn(4))));
  });
  read_curves(database, cases, later);
  per_case(database, cases, "case_tables", [&](CaseRecord& record, Statement& row) {
    // What the columns mean is not stored: the kind of study declares it.
    const Json content = json_in(row.getColumn(3));
    const std::string name = row.getColumn(2).getString();
    if (!is_table_name(name)) throw BadRow();
    if (record.tables.empty() || record.tables.back().name != name) {
      Table& first = record.tables.emplace_back();
      first.name = name;
      first.columns = cases.named(content.at("columns").get<std::vector<std::string>>());
    }
    Table& table = record.tables.back();
    for (const Json& cells : content.at("rows")) {
      Row& one = table.rows.emplace_back();
      for (const Json& cell : cells) one.push_back(cell_of(cell));
      if (one.size() != table.columns.size()) throw BadRow();
    }
  });
  read_numbers(database, cases, later);
}

/// Reads every case, its rows once: for what they say and for their checksums.
void read_all_cases(SQLite::Database& database, bool compared, StoredSeries* later, StudyResults& results) {
  CaseSums sums;
  ReadCases cases;
  if (!compared) cases.sums = &sums;
  read_cases(database, cases.sums, results);
  for (CaseRecord& record : results.cases) cases.records[record.id] = &record;
  if (!cases.records.empty()) read_rows(database, cases, later);
  if (!compared) results.damage.merge(damaged_cases(database, sums.texts()));
  results.damage.cases.merge(cases.damaged);
}

/// Of a file with pages that cannot be read: what is whole, case by case.
void read_whole_cases(SQLite::Database& database, StoredSeries* later, StudyResults& results) {
  results.cases.clear();
  results.damage.merge(find_damage(database));
  try {
    read_cases(database, nullptr, results);
  } catch (const SQLite::Exception&) {
    results.damage.pages = true;
  }
  for (CaseRecord& record : results.cases) {
    if (results.damage.cases.contains(record.id)) continue;
    ReadCases one{{{record.id, &record}}};
    read_rows(database, one, later);
    results.damage.cases.merge(one.damaged);
  }
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
  while (rows.executeStep()) environment.entries.emplace_back(text_in(rows.getColumn(0)), text_in(rows.getColumn(1)));
  return environment;
}

StudyResults read_tables(SQLite::Database& database, bool compared) {
  StudyResults results;
  SQLite::Transaction transaction(database);
  read_study(database, results);
  const auto later = std::make_shared<StoredSeries>(database.getFilename());
  try {
    read_all_cases(database, compared, later.get(), results);
  } catch (const SQLite::Exception&) {
    if (compared) throw;
    results.damage.pages = true;
  }
  if (results.damage.pages) read_whole_cases(database, later.get(), results);
  std::erase_if(results.cases, [&](const CaseRecord& record) { return results.damage.cases.contains(record.id); });
  for (CaseRecord& record : results.cases) record.id = id_of_today(record.id);
  if (!results.damage.environment) results.environment = read_environment(database);
  tell_arithmetics(results);
  return results;
}

StudyResults read_head(SQLite::Database& database) {
  StudyResults results;
  read_study(database, results);
  if (!results.damage.environment) results.environment = read_environment(database);
  return results;
}

std::optional<CaseRecord> read_case(SQLite::Database& database, const std::string& id) {
  SQLite::Statement row(database, rows_query("", "cases", kCaseColumns, false) + " WHERE id = ? OR id = ?");
  row.bind(1, id);
  row.bind(2, former_id(id));
  if (!row.executeStep()) return std::nullopt;
  std::optional<CaseRecord> found = case_of(row);
  if (!found) throw StoreError(damage_text(database.getFilename(), {.cases = {row.getColumn(0).getString()}}));
  CaseRecord& record = *found;
  ReadCases only{{{record.id, &record}}};
  read_rows(database, only, nullptr);
  if (!only.damaged.empty()) throw StoreError(damage_text(database.getFilename(), {.cases = only.damaged}));
  record.id = id_of_today(record.id);
  return found;
}

std::string find_motion(SQLite::Database& database, const std::string& whole_key) {
  SQLite::Statement find(database, "SELECT content FROM motions WHERE key = ?");
  find.bind(1, whole_key);
  if (!find.executeStep()) return "";
  const SQLite::Column blob = find.getColumn(0);
  std::string content(static_cast<const char*>(blob.getBlob()), static_cast<std::size_t>(blob.getBytes()));
  if (!database.tableExists("motion_sums")) return content;
  SQLite::Statement stated(database, "SELECT sum FROM motion_sums WHERE key = ?");
  stated.bind(1, whole_key);
  // What is damaged is computed again.
  return stated.executeStep() && stated.getColumn(0).getString() != checksum_of(content) ? "" : content;
}

std::unique_ptr<SQLite::Database> open_store(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "results.sqlite";
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw StoreError(fmt::format("{}: there is no results.sqlite here{}; expected the folder of a study that was run",
                                 folder.string(), error ? " (" + error.message() + ")" : ""));
  check_regular(file);
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

StudyResults read_what_is_whole(const std::filesystem::path& folder) {
  StudyResults results;
  with_store(folder, [&](SQLite::Database& database) { results = read_tables(database); });
  return results;
}

StudyResults read_store(const std::filesystem::path& folder) {
  StudyResults results = read_what_is_whole(folder);
  if (results.damage.any()) throw StoreError(damage_text(folder / "results.sqlite", results.damage));
  return results;
}

std::string read_motion(const std::filesystem::path& folder, const std::string& key, const std::string& arithmetic) {
  std::string content;
  with_store(folder, [&](SQLite::Database& database) { content = find_motion(database, motion_key(arithmetic, key)); });
  return content;
}

}  // namespace ricochet
