#include "runners/store/store.hpp"

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <numeric>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/store/number_rows.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/schema.hpp"
#include "runners/store/statements.hpp"
#include "runners/study/case_id.hpp"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// About, of what may be large.
std::size_t bytes_of(const CaseRecord& record) {
  std::size_t numbers = 0;
  for (const auto& column : record.curve.columns) numbers += column.size();
  for (const NumberTable& table : record.numbers)
    for (const auto& column : table.values) numbers += column.size();
  for (const Table& table : record.tables) numbers += table.rows.size() * table.columns.size();
  return numbers * sizeof(double);
}

}  // namespace

Store::Store(const std::filesystem::path& folder, bool fresh, bool locked) : file_(folder / "results.sqlite") {
  make_folder(folder);
  if (locked) lock_.emplace(folder);
  remove_leftovers(folder);
  remove_leftovers(folder / "curves");
  check_owner(file_);
  if (fresh) forget_store(file_);
  guarded(file_, nullptr, [&] {
    constexpr int wait_ms =
        10000;  // a reader (a report being rebuilt, a database browser) may hold the file for a moment
    database_ = std::make_unique<SQLite::Database>(file_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, wait_ms);
  });
  guarded(file_, database_.get(), [&] {
    // Rollback journal, not WAL: between two cases the record is one plain file. It can be copied, archived, read from
    // a folder without write permission and kept on a network disk. FULL: with a rollback journal NORMAL may damage the
    // file at a power cut. It costs a few ms, which cases that end closely share. A killed process loses nothing that
    // was committed under either. The cache, KiB, holds what one transaction changes until it is committed. It holds
    // the indices of a study of many cases, which each case enters at a place of its own.
    database_->exec(
        "PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON; PRAGMA cache_size=-131072;");
  });
  prepare_schema(*database_, file_, true);
  prepared_ = std::make_unique<Statements>(*database_);
  group_ = std::make_unique<WriteGroup>(*database_, mutex_, [this] { epoch_.check(*database_, file_); });
}

std::set<std::string> Store::begin(const StudyResults& study, const std::vector<ExpectedCase>& expected,
                                   const std::string& arithmetic) {
  const std::lock_guard guard(mutex_);
  arithmetic_ = arithmetic;
  expected_.clear();
  for (std::size_t i = 0; i < expected.size(); ++i)
    expected_[expected[i].id] = {expected[i].fingerprint, static_cast<int>(i)};
  std::set<std::string> kept;
  write_alone([&] {
    SQLite::Statement name(*database_, "SELECT value FROM study WHERE key = 'name'");
    const std::set<std::string> unsure = damaged_keys(*database_);
    if (name.executeStep() && !unsure.contains("name")) {
      const std::string stored = Json::parse(name.getColumn(0).getString()).get<std::string>();
      if (stored != study.name)
        throw StoreError(
            fmt::format("{}: this folder holds the results of the study \"{}\", not of \"{}\"; choose "
                        "another folder with --out, or forget them with --fresh",
                        file_.string(), stored, study.name));
    }
    name.reset();
    epoch_.raise(*database_, file_);
    const std::filesystem::path curves = file_.parent_path() / "curves";
    std::error_code ignored;  // a curve that is not there, or stays, is written anew
    for (const std::string& id : name_as_today(*database_))
      std::filesystem::rename(curves / (id + ".csv"), curves / (id_of_today(id) + ".csv"), ignored);
    kept = settle_rows();
    SQLite::Statement state(*database_, "INSERT OR REPLACE INTO study(key, value) VALUES(?, ?)");
    insert(state, "name", text_of(study.name));
    insert(state, "question", text_of(study.question));
    insert(state, "kind", text_of(study.kind));
    insert(state, "resolved", text_of(study.study));
    insert(state, "columns", text_of(study.columns));
    Json axes = Json::array();
    for (const Column& axis : study.axes) axes.push_back({axis.name, axis.unit, axis.text});
    insert(state, "axes", text_of(axes));
    insert(state, "method_words", text_of(study.method_words));
    insert(state, "expected_cases", text_of(study.expected_cases));
    insert(state, "part", text_of({study.part.number, study.part.of}));
    state.reset();
    seal_study(*database_);
  });
  rows_ = kept;
  begun_ = true;
  return kept;
}

std::optional<StudyPart> Store::part() const {
  const std::lock_guard guard(mutex_);
  std::optional<StudyPart> part;
  guarded(file_, database_.get(), [&] { part = read_part(*database_); });
  return part;
}

int Store::aside() const {
  const std::lock_guard guard(mutex_);
  int count = 0;
  guarded(file_, database_.get(), [&] { count = count_aside(*database_); });
  return count;
}

int Store::of_other_arithmetic() const {
  const std::lock_guard guard(mutex_);
  int count = 0;
  guarded(file_, database_.get(), [&] {
    SQLite::Statement others(*database_,
                             "SELECT count(*) FROM cases WHERE fingerprint != '' AND status != 'refused' AND "
                             "arithmetic NOT IN ('', ?)");
    others.bind(1, arithmetic_);
    if (others.executeStep()) count = others.getColumn(0).getInt();
  });
  return count;
}

Environment Store::environment() const {
  const std::lock_guard guard(mutex_);
  Environment environment;
  guarded(file_, database_.get(), [&] { environment = read_environment(*database_); });
  return environment;
}

void Store::write_environment(const Environment& environment) {
  database_->exec("DELETE FROM environment");
  SQLite::Statement add(*database_, "INSERT INTO environment(position, name, value) VALUES(?, ?, ?)");
  int position = 0;
  for (const auto& [name, value] : environment.entries) insert(add, position++, name, value);
  add.reset();
  seal_study(*database_);
}

void Store::save_environment(const Environment& environment) {
  const std::lock_guard guard(mutex_);
  write_alone([&] { write_environment(environment); });
}

void Store::write(std::size_t bytes, const std::function<void()>& rows) {
  guarded(file_, database_.get(), [&] { group_->write(bytes, rows); });
}

void Store::write_alone(const std::function<void()>& rows) {
  guarded(file_, database_.get(), [&] { group_->write_alone(rows); });
}

void Store::note_begin(const std::string& id, Stage stage) {
  insert(prepared_->of("INSERT OR REPLACE INTO begun(case_id, stage, since) VALUES(?, ?, ?)"), id,
         std::string(stage == Stage::run ? "run" : "plan"), utc_time());
}

void Store::begins(const std::vector<std::string>& ids, Stage stage) {
  const std::lock_guard guard(mutex_);
  write(0, [&] {
    for (const std::string& id : ids) note_begin(id, stage);
  });
}

std::vector<std::string> Store::left_under_way() const {
  const std::lock_guard guard(mutex_);
  std::vector<std::string> ids;
  guarded(file_, database_.get(), [&] {
    SQLite::Statement begun(*database_, "SELECT case_id FROM begun WHERE stage = 'run'");
    while (begun.executeStep()) ids.push_back(id_of_today(begun.getColumn(0).getString()));
  });
  return ids;
}

std::set<std::string> Store::failed() const {
  const std::lock_guard guard(mutex_);
  std::set<std::string> ids;
  guarded(file_, database_.get(), [&] {
    SQLite::Statement failed(*database_, "SELECT id FROM cases WHERE status = 'failed' AND fingerprint != ''");
    while (failed.executeStep()) ids.insert(failed.getColumn(0).getString());
  });
  return ids;
}

void Store::nothing_under_way() {
  const std::lock_guard guard(mutex_);
  write_alone([&] {
    database_->exec("DELETE FROM begun");
    database_->exec("DELETE FROM study WHERE key = 'progress'");
  });
}

void Store::save_progress(const std::string& text) {
  const std::lock_guard guard(mutex_);
  write(text.size(), [&] {
    SQLite::Statement state(*database_, "INSERT OR REPLACE INTO study(key, value) VALUES(?, ?)");
    insert(state, "progress", text_of(Json{{"text", text}, {"at", utc_time()}}));
  });
}

void Store::save(std::span<const CaseRecord> records) {
  const std::lock_guard guard(mutex_);
  const auto size = std::accumulate(records.begin(), records.end(), std::size_t{0},
                                    [](std::size_t sum, const CaseRecord& record) { return sum + bytes_of(record); });
  write(size, [&] {
    SQLite::Statement& ended = prepared_->of("DELETE FROM begun WHERE case_id = ?");
    for (const CaseRecord& record : records) {
      save_one(record, false);
      insert(ended, record.id);
    }
  });
}

void Store::save_partial(const CaseRecord& record) {
  const std::lock_guard guard(mutex_);
  write(0, [&] { save_one(record, true); });
  guarded(file_, database_.get(), [&] { group_->commit(); });
}

void Store::save_one(const CaseRecord& record, bool partial) {
  const auto expected = expected_.find(record.id);
  if (expected == expected_.end()) throw std::logic_error("a case that begin() did not announce: " + record.id);
  // A case that is saved again (timed after it ran) takes its rows with it.
  if (!rows_.insert(record.id).second) insert(prepared_->of("DELETE FROM cases WHERE id = ?"), record.id);
  SQLite::Statement& add = prepared_->of("INSERT INTO cases VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  const auto& [fingerprint, case_position] = expected->second;
  // No case has the fingerprint "": what is partial is never taken for finished.
  insert(add, record.id, case_position, partial ? std::string() : fingerprint, word(record.status), record.reason(),
         static_cast<std::int64_t>(record.steps), record.setup_seconds, record.run_seconds, record.operator_name,
         record.arithmetic.empty() ? arithmetic_ : record.arithmetic);

  int position = 0;
  SQLite::Statement& axis = prepared_->of("INSERT INTO axes VALUES(?, ?, ?, ?)");
  for (const auto& [name, value] : record.axes) insert(axis, record.id, position++, name, text_of(value));

  std::vector<std::string> notes = record.notes;
  position = 0;
  SQLite::Statement& measure = prepared_->of("INSERT INTO measures VALUES(?, ?, ?, ?)");
  for (const auto& [name, value] : record.measures)
    if (std::isfinite(value))
      insert(measure, record.id, position++, name, value);
    else
      notes.push_back(fmt::format("{} is not a finite number and is left out", name));

  position = 0;
  SQLite::Statement& left_out = prepared_->of("INSERT INTO left_out VALUES(?, ?, ?, ?)");
  for (const auto& [item, reason] : record.left_out) insert(left_out, record.id, position++, item, reason);

  position = 0;
  SQLite::Statement& reason = prepared_->of("INSERT INTO reasons VALUES(?, ?, ?, ?, ?)");
  for (const Said& one : record.reasons) {
    Json marks = Json::array();
    for (const Mark& mark : one.marks) marks.push_back({mark.begin, mark.size});
    insert(reason, record.id, position++, record.excluded ? 1 : 0, one.text, marks.dump());
  }

  position = 0;
  SQLite::Statement& note = prepared_->of("INSERT INTO notes VALUES(?, ?, ?)");
  for (const std::string& text : notes) insert(note, record.id, position++, text);

  save_tables(record);
  save_curve(record);
  save_numbers(record);
  seal_case(*prepared_, "", record.id);
}

void Store::save_tables(const CaseRecord& record) {
  int position = 0;
  SQLite::Statement& table = prepared_->of("INSERT INTO case_tables VALUES(?, ?, ?, ?)");
  for (const Table& one : record.tables) {
    Json columns = Json::array();
    for (const Column& column : one.columns) columns.push_back(column.name);
    // As JSON a row takes ten times its memory.
    constexpr std::size_t piece = 16384;
    for (std::size_t first = 0; first == 0 || first < one.rows.size(); first += piece) {
      Json rows = Json::array();
      for (std::size_t r = first; r < std::min(first + piece, one.rows.size()); ++r) {
        Json& cells = rows.emplace_back(Json::array());
        for (const Cell& cell : one.rows[r]) cells.push_back(json_of(cell));
      }
      const Json content = {{"columns", columns}, {"rows", std::move(rows)}};
      insert(table, record.id, position++, one.name, text_of(content));
    }
  }
}

void Store::save_curve(const CaseRecord& record) {
  SQLite::Statement& curve = prepared_->of("INSERT INTO curves VALUES(?, ?, ?, ?)");
  for (std::size_t i = 0; i < record.curve.columns.size(); ++i) {
    curve.reset();
    curve.bind(1, record.id);
    curve.bind(2, static_cast<int>(i));
    curve.bind(3, record.curve.names.at(i));
    const std::vector<double>& samples = record.curve.columns[i];
    bind_series(curve, 4, samples.data(), samples.size());
    curve.exec();
  }
}

void Store::save_numbers(const CaseRecord& record) {
  int position = 0;
  for (const NumberTable& table : record.numbers)
    insert_numbers(prepared_->of(insert_numbers_sql), record.id, position, table);
}

std::string Store::motion(const std::string& key) const {
  const std::lock_guard guard(mutex_);
  std::string content;
  guarded(file_, database_.get(), [&] { content = find_motion(*database_, motion_key(arithmetic_, key)); });
  return content;
}

void Store::save_motion(const std::string& key, const std::string& content) {
  const std::lock_guard guard(mutex_);
  write_alone([&] {
    SQLite::Statement change(*database_, content.empty() ? "DELETE FROM motions WHERE key = ?"
                                                         : "INSERT OR REPLACE INTO motions(key, content) VALUES(?, ?)");
    change.bind(1, motion_key(arithmetic_, key));
    if (!content.empty()) change.bindNoCopy(2, content.data(), static_cast<int>(content.size()));
    change.exec();
    if (!content.empty())
      insert(prepared_->of("INSERT OR REPLACE INTO motion_sums(key, sum) VALUES(?, ?)"), motion_key(arithmetic_, key),
             checksum_of(content));
  });
}

void Store::make_views(const StudyResults& results) {
  const std::lock_guard guard(mutex_);
  write_alone([&] { ricochet::make_views(*database_, results); });
}

StudyResults Store::load() const {
  const std::lock_guard guard(mutex_);
  StudyResults results;
  guarded(file_, database_.get(), [&] {
    group_->commit();
    results = read_tables(*database_, begun_);
  });
  if (results.damage.any()) throw StoreError(damage_text(file_, results.damage));
  return results;
}

}  // namespace ricochet
