#include "runners/store/store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>

#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"

using namespace ricochet;

namespace {

const std::vector<ExpectedCase> kExpected = {{"0123456789", "f1"}, {"abcdefabcd", "f2"}};

void fill(const std::filesystem::path& folder) {
  Store store(folder, false);
  const StudyResults results = sample_results();
  store.begin(results, kExpected);
  store.save_environment(results.environment);
  store.save(results.cases);
}

std::string open_error(const std::filesystem::path& folder, bool fresh = false) {
  try {
    Store store(folder, fresh);
    store.begin(sample_results(), kExpected);
  } catch (const StoreError& error) {
    return error.what();
  }
  return "";
}

void check_equal(const CaseRecord& a, const CaseRecord& b) {
  CHECK(a.id == b.id);
  CHECK(a.axes == b.axes);
  CHECK(a.status == b.status);
  CHECK(a.reason == b.reason);
  CHECK(a.steps == b.steps);
  CHECK(a.setup_seconds == b.setup_seconds);
  CHECK(a.run_seconds == b.run_seconds);
  CHECK(a.measures == b.measures);
  CHECK(a.left_out == b.left_out);
  CHECK(a.notes == b.notes);
  CHECK(a.operator_name == b.operator_name);
  CHECK(a.curve.names == b.curve.names);
  CHECK(a.curve.columns == b.curve.columns);
  CHECK(a.partial == b.partial);
  REQUIRE(a.numbers.size() == b.numbers.size());
  for (std::size_t t = 0; t < a.numbers.size(); ++t) {
    const NumberTable &x = a.numbers[t], &y = b.numbers[t];
    CHECK(x.name == y.name);
    CHECK(x.words == y.words);
    CHECK(x.exported == y.exported);
    REQUIRE(x.columns.size() == y.columns.size());
    REQUIRE(x.values.size() == y.values.size());
    // NaN is a value here: bits, not equality.
    for (std::size_t c = 0; c < x.values.size(); ++c) {
      CHECK(x.columns[c].name == y.columns[c].name);
      REQUIRE(x.values[c].size() == y.values[c].size());
      const std::size_t size = x.values[c].size() * sizeof(double);
      CHECK((size == 0 || std::memcmp(x.values[c].get().data(), y.values[c].get().data(), size) == 0));
    }
  }
}

int count(const std::filesystem::path& folder, const std::string& what) {
  const SQLite::Database database(folder / "results.sqlite");
  SQLite::Statement rows(database, "SELECT count(*) FROM " + what);
  rows.executeStep();
  return rows.getColumn(0).getInt();
}

}  // namespace

TEST_CASE("store: everything comes back, to the last bit") {
  const ScratchFolder folder;
  fill(folder.path());
  const StudyResults in = sample_results(), out = read_store(folder.path());
  CHECK(out.name == in.name);
  CHECK(out.question == in.question);
  CHECK(out.kind == in.kind);
  CHECK(out.study == in.study);
  CHECK(out.columns == in.columns);
  CHECK(out.expected_cases == in.expected_cases);
  CHECK(out.environment.entries == in.environment.entries);
  REQUIRE(out.cases.size() == in.cases.size());
  for (std::size_t i = 0; i < in.cases.size(); ++i) check_equal(out.cases[i], in.cases[i]);
}

TEST_CASE("store: between two cases the record is one file, readable while the run has it open") {
  const ScratchFolder folder;
  Store store(folder.path(), false);
  const StudyResults results = sample_results();
  store.begin(results, kExpected);
  store.save({results.cases.data(), 1});
  CHECK_FALSE(std::filesystem::exists(folder / "results.sqlite-journal"));
  CHECK_FALSE(std::filesystem::exists(folder / "results.sqlite-wal"));
  const StudyResults seen = read_store(folder.path());
  CHECK(seen.cases.size() == 1);
  CHECK(seen.expected_cases == 2);
}

TEST_CASE("store: cases are in the study's order, whatever the order they finished in") {
  const ScratchFolder folder;
  Store store(folder.path(), false);
  const StudyResults results = sample_results();
  store.begin(results, kExpected);
  store.save({results.cases.data() + 1, 1});
  store.save({results.cases.data(), 1});
  const StudyResults seen = store.load();
  REQUIRE(seen.cases.size() == 2);
  CHECK(seen.cases[0].id == kExpected[0].id);
}

TEST_CASE("store: kept are the cases whose fingerprint is the same, others and foreign ones are no longer there") {
  const ScratchFolder folder;
  fill(folder.path());
  Store store(folder.path(), false);
  SECTION("nothing changed") {
    CHECK(store.begin(sample_results(), kExpected).size() == 2);
  }
  SECTION("one fingerprint changed") {
    const auto kept = store.begin(sample_results(), {{"0123456789", "f1"}, {"abcdefabcd", "other"}});
    CHECK(kept == std::set<std::string>{"0123456789"});
    CHECK(store.load().cases.size() == 1);
  }
  SECTION("one case left the study, and the order changed") {
    const auto kept = store.begin(sample_results(), {{"new", "f3"}, {"abcdefabcd", "f2"}});
    CHECK(kept == std::set<std::string>{"abcdefabcd"});
    CHECK(store.load().cases.front().id == "abcdefabcd");
  }
  SECTION("a case that is set aside, or dropped, leaves nothing in any table") {
    store.begin(sample_results(), {});
    for (const char* table :
         {"cases", "axes", "measures", "left_out", "notes", "curves", "case_tables", "case_numbers"})
      CHECK(count(folder.path(), table) == 0);
  }
}

TEST_CASE("store: what an edit no longer asks for is set aside, and comes back whole when it is asked for again") {
  const ScratchFolder folder;
  fill(folder.path());
  const std::vector<ExpectedCase> edited = {{"0123456789", "g1"}, {"abcdefabcd", "g2"}};
  StudyResults after = sample_results();
  after.cases[0].measures = {{"impacts", 3}};
  {
    Store store(folder.path(), false);
    CHECK(store.begin(sample_results(), edited).empty());
    CHECK(store.aside() == 1);  // nothing was computed for the refused one
    CHECK(store.returned() == 0);
    CHECK(store.load().cases.empty());
    store.save(after.cases);
  }
  SECTION("undone") {
    Store store(folder.path(), false);
    CHECK(store.begin(sample_results(), kExpected) == std::set<std::string>{"0123456789"});
    CHECK(store.returned() == 1);
    CHECK(store.aside() == 1);  // that of the edited study now
    const StudyResults back = store.load();
    REQUIRE(back.cases.size() == 1);
    check_equal(back.cases[0], sample_results().cases[0]);
    CHECK(store.begin(sample_results(), edited) == std::set<std::string>{"0123456789"});
    check_equal(store.load().cases[0], after.cases[0]);
    // As if nothing had been aside: the order of the study, too.
    CHECK(store.begin(sample_results(), {{"other", "o"}, {"0123456789", "f1"}}).size() == 1);
    CHECK(count(folder.path(), "cases WHERE position = 1") == 1);
  }
  SECTION("fresh") {
    Store store(folder.path(), true);
    CHECK(store.begin(sample_results(), kExpected).empty());
    CHECK(store.aside() == 0);
  }
  SECTION("begun again with the same edit: nothing moves") {
    Store store(folder.path(), false);
    CHECK(store.begin(after, edited).size() == 2);
    CHECK(store.aside() == 1);
    CHECK(store.returned() == 0);
  }
}

TEST_CASE("store: failed cases are kept aside, refused and unfinished ones are not") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  results.cases[1].status = "failed";
  Store store(folder.path(), false);
  store.begin(results, kExpected);
  store.save_partial(results.cases[0]);
  store.save({results.cases.data() + 1, 1});
  store.begin(results, {});
  CHECK(store.aside() == 1);
  CHECK(store.begin(results, kExpected) == std::set<std::string>{"abcdefabcd"});
  CHECK(store.failed() == std::set<std::string>{"abcdefabcd"});
}

TEST_CASE("store: an environment goes with its cases") {
  const ScratchFolder folder;
  using Entries = std::vector<std::pair<std::string, std::string>>;
  const Entries old = sample_results().environment.entries, now = {{"program", "newer"}, {"cores", "2"}};
  fill(folder.path());
  Store store(folder.path(), false);
  store.begin(sample_results(), {{"0123456789", "g1"}, {"abcdefabcd", "g2"}});
  store.save(sample_results().cases);
  store.save_environment({now});
  store.begin(sample_results(), kExpected);
  CHECK(store.load().environment.entries == old);
  // One case of each.
  store.begin(sample_results(), {{"0123456789", "f1"}, {"abcdefabcd", "f2"}});
  store.save(sample_results().cases);
  store.begin(sample_results(), {{"0123456789", "g1"}, {"abcdefabcd", "f2"}});
  CHECK(store.load().environment.entries ==
        Entries{{"program", "ricochet"}, {"cores", "2"}, {"program (earlier cases)", "newer"}});
}

TEST_CASE("store: the curve file of a case goes with its row, before another takes its place") {
  const ScratchFolder folder;
  fill(folder.path());
  std::filesystem::create_directory(folder / "curves");
  const auto file = folder / "curves/0123456789.csv";
  write_text(file, "old");
  Store store(folder.path(), false);
  store.begin(sample_results(), kExpected);
  CHECK(std::filesystem::exists(file));
  store.begin(sample_results(), {{"0123456789", "g1"}});
  CHECK_FALSE(std::filesystem::exists(file));
  write_text(file, "new");
  store.begin(sample_results(), kExpected);
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("store: fresh forgets") {
  const ScratchFolder folder;
  fill(folder.path());
  Store store(folder.path(), true);
  CHECK(store.load().cases.empty());
}

TEST_CASE("store: a measure that is not finite is left out, and said") {
  const ScratchFolder folder;
  Store store(folder.path(), false);
  StudyResults results = sample_results();
  results.cases[0].measures.emplace_back("impulse", std::numeric_limits<double>::quiet_NaN());
  store.begin(results, kExpected);
  store.save(results.cases);
  const CaseRecord record = store.load().cases[0];
  CHECK(record.measures.size() == 2);
  CHECK(record.notes.back() == "impulse is not a finite number and is left out");
}

TEST_CASE("store: another version is refused with what was found, expected and to do") {
  const ScratchFolder folder;
  fill(folder.path());
  SQLite::Database(folder / "results.sqlite", SQLite::OPEN_READWRITE).exec("PRAGMA user_version=99");
  using Catch::Contains;
  CHECK_THAT(open_error(folder.path()),
             Contains("results.sqlite") && Contains("version 99") && Contains("version 7") && Contains("--fresh"));
  CHECK_THROWS_AS(read_store(folder.path()), StoreError);
  CHECK(open_error(folder.path(), true).empty());
}

TEST_CASE("store: what earlier versions wrote is read, and gets the tables that came later") {
  const ScratchFolder folder;
  fill(folder.path());
  const int version = GENERATE(1, 2, 3, 4, 5, 6);
  {
    SQLite::Database database(folder / "results.sqlite", SQLite::OPEN_READWRITE);
    if (version < 6) database.exec("DROP TABLE epoch; ALTER TABLE cases DROP COLUMN arithmetic");
    if (version == 5) database.exec("ALTER TABLE aside_cases DROP COLUMN arithmetic");
    for (const char* table :
         {"axes", "measures", "left_out", "notes", "curves", "case_tables", "case_numbers", "cases", "environments"})
      if (version < 5) database.exec(std::string("DROP TABLE aside_") + table);
    if (version < 4) database.exec("DROP TABLE begun");
    if (version < 3) database.exec("DROP TABLE case_numbers");
    if (version < 2) database.exec("DROP TABLE case_tables; DROP TABLE motions");
    database.exec("PRAGMA user_version=" + std::to_string(version));
  }
  const StudyResults before = read_store(folder.path());
  REQUIRE(before.cases.size() == 2);
  CHECK(before.cases[0].numbers.empty() == (version < 3));
  CHECK_FALSE(before.cases[0].partial);
  {
    Store store(folder.path(), false);
    CHECK(store.begin(sample_results(), kExpected).size() == 2);
    store.save(sample_results().cases);
    store.save_motion("key", "content");
  }
  check_equal(read_store(folder.path()).cases[0], sample_results().cases[0]);
}

TEST_CASE("store: tables of any length come back as one table each") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  CaseRecord& record = results.cases.front();
  // Longer than what is written at once: rows of cells, and columns of numbers.
  Table cells{"cells", "", named_columns({"x", "class"}), {}};
  for (int i = 0; i < 40000; ++i) cells.rows.push_back({0.5 * i, i % 3 == 0 ? Cell("periodic") : Cell()});
  record.tables = {cells, {"next", "", named_columns({"y"}), {{1.5}}}, {"empty", "", named_columns({"z"}), {}}};
  NumberTable points = number_table("cell_points", named_columns({"cell", "tip"}));
  for (int i = 0; i < 2500000; ++i) points.add({static_cast<double>(i / 2), 0.1 * i});
  record.numbers.push_back(points);
  {
    Store store(folder.path(), false);
    store.begin(results, kExpected);
    store.save(results.cases);
  }
  const CaseRecord back = read_store(folder.path()).cases.front();
  REQUIRE(back.tables.size() == 3);
  CHECK(back.tables[0].rows == cells.rows);
  CHECK(back.tables[1].rows == record.tables[1].rows);
  CHECK(back.tables[2].rows.empty());
  REQUIRE(back.numbers.size() == record.numbers.size());
  CHECK(back.numbers.back().values == points.values);
}

TEST_CASE("store: a case that begins is there before it ends, and gone once its row is") {
  const ScratchFolder folder;
  const StudyResults results = sample_results();
  const std::string &first = results.cases[0].id, &second = results.cases[1].id;
  using Ids = std::vector<std::string>;
  {
    Store store(folder.path(), false);
    store.begin(results, kExpected);
    store.begins({first, second}, Store::Stage::plan);
    CHECK(store.left_under_way().empty());  // none of them runs yet
    store.begins({first}, Store::Stage::run);
    CHECK(store.left_under_way() == Ids{first});
    store.save({results.cases.data(), 1}, second);
    CHECK(store.left_under_way() == Ids{second});
  }
  CHECK(count(folder.path(), "begun") == 1);
  Store store(folder.path(), false);
  CHECK(store.begin(results, kExpected) == std::set<std::string>{first});
  CHECK(store.left_under_way() == Ids{second});
  store.nothing_under_way();
  CHECK(store.left_under_way().empty());
}

TEST_CASE("store: what a running case has so far is shown, marked, replaced, and never taken for finished") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  CaseRecord early = results.cases[0];
  early.steps = 10;
  early.numbers[0].values = {{0.07}, {1}, {0.5}};
  {
    Store store(folder.path(), false);
    store.begin(results, kExpected);
    store.save_partial(early);
    const StudyResults seen = read_store(folder.path());
    REQUIRE(seen.cases.size() == 1);
    CHECK(seen.cases[0].partial);
    CHECK(seen.cases[0].steps == 10);
    CHECK(seen.cases[0].numbers[0].rows() == 1);
    early.steps = 20;
    store.save_partial(early);
    CHECK(store.load().cases[0].steps == 20);
    CHECK(store.load().cases.size() == 1);
  }
  SECTION("finished") {
    Store store(folder.path(), false);
    store.begin(results, kExpected);
    store.save_partial(early);
    store.save({results.cases.data(), 1});
    check_equal(store.load().cases[0], results.cases[0]);
    CHECK(count(folder.path(), "case_numbers") == 6);  // columns of three tables
  }
  SECTION("interrupted: it runs again") {
    Store store(folder.path(), false);
    CHECK(store.begin(results, kExpected).empty());
    CHECK(store.load().cases.empty());
    CHECK(count(folder.path(), "case_numbers") == 0);
  }
}

TEST_CASE("store: a motion is kept under its key until it is emptied") {
  const ScratchFolder folder;
  Store store(folder.path(), false);
  std::string bytes(1000, '\0');
  bytes += "end";
  CHECK(store.motion("a").empty());
  store.save_motion("a", bytes);
  store.save_motion("b", "other");
  CHECK((store.motion("a") == bytes));
  store.save_motion("a", "");
  store.save_motion("never there", "");
  CHECK(store.motion("a").empty());
  CHECK(store.motion("b") == "other");
  CHECK(count(folder.path(), "motions") == 1);
}

TEST_CASE("store: a file that is not ours is refused and never removed") {
  const ScratchFolder folder;
  SECTION("text") {
    write_text(folder / "results.sqlite", std::string(5000, 'x'));
  }
  SECTION("short text") {
    write_text(folder / "results.sqlite", "x");
  }
  SECTION("the database of another program") {
    SQLite::Database(folder / "results.sqlite", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("CREATE TABLE mine(x); PRAGMA user_version=7");
  }
  SECTION("the database of a program that names neither itself nor a version") {
    SQLite::Database(folder / "results.sqlite", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
        .exec("CREATE TABLE mine(x)");
  }
  const std::string before = read_text(folder / "results.sqlite");
  CHECK_THAT(open_error(folder.path()), Catch::Contains("not a Ricochet store"));
  CHECK_THAT(open_error(folder.path(), true), Catch::Contains("not a Ricochet store"));
  CHECK((read_text(folder / "results.sqlite") == before));
}

TEST_CASE("store: a store whose creation was cut short is begun anew") {
  const ScratchFolder folder;
  write_text(folder / "results.sqlite", "");
  CHECK_THROWS_AS(read_store(folder.path()), StoreError);
  fill(folder.path());
  CHECK(read_store(folder.path()).cases.size() == 2);
}

TEST_CASE("store: the results of another study are not overwritten") {
  const ScratchFolder folder;
  fill(folder.path());
  Store store(folder.path(), false);
  StudyResults other = sample_results();
  other.name = "other";
  CHECK_THROWS_WITH(store.begin(other, {}), Catch::Contains("\"sample\"") && Catch::Contains("\"other\""));
  CHECK(store.load().cases.size() == 2);
}

TEST_CASE("store: a folder that cannot be") {
  const ScratchFolder folder;
  write_text(folder / "file", "in the way");
  CHECK_THAT(open_error(folder / "file"), Catch::Contains((folder / "file").string()));
  CHECK_THAT(open_error(folder / "file/below"), Catch::Contains((folder / "file/below").string()));
  std::filesystem::create_directories(folder / "results.sqlite");
  CHECK_THAT(open_error(folder.path()), Catch::Contains("results.sqlite") && Catch::Contains("cannot be opened"));
  CHECK_THROWS_WITH(read_store(folder / "absent"), Catch::Contains("there is no results.sqlite here"));
}

TEST_CASE("store: one run at a time, and the other is named") {
  const ScratchFolder folder;
  {
    const Store first(folder.path(), false);
    CHECK_THAT(open_error(folder.path()),
               Catch::Contains("another run") && Catch::Contains("process " + std::to_string(::getpid())));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "results.lock"));
  CHECK(open_error(folder.path()).empty());
}
