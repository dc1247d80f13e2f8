#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"
#include "tests/runners/store/stored_study.hpp"

namespace store_tests {

TEST_CASE("store: another version is refused with what was found, expected and to do") {
  const ScratchFolder folder;
  fill(folder.path());
  SQLite::Database(folder / "results.sqlite", SQLite::OPEN_READWRITE).exec("PRAGMA user_version=99");
  using Catch::Contains;
  CHECK_THAT(open_error(folder.path()),
             Contains("results.sqlite") && Contains("version 99") && Contains("version 9") && Contains("--fresh"));
  CHECK_THROWS_AS(read_store(folder.path()), StoreError);
  CHECK(open_error(folder.path(), true).empty());
}

TEST_CASE("store: what earlier versions wrote is read, and gets the tables that came later") {
  const ScratchFolder folder;
  fill(folder.path());
  const int version = GENERATE(1, 2, 3, 4, 5, 6, 7, 8);
  {
    SQLite::Database database(folder / "results.sqlite", SQLite::OPEN_READWRITE);
    // Its checksums know nothing of rows that came later.
    database.exec("DELETE FROM reasons");
    seal_cases(database, "");
    database.exec("DROP TABLE reasons; DROP TABLE aside_reasons");
    if (version < 8) database.exec("DROP TABLE sums; DROP TABLE aside_sums; DROP TABLE motion_sums");
    if (version < 8) database.exec("DELETE FROM study WHERE key = 'checksums'");
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
    store.save({results.cases.data(), 1});
    store.begins({second}, Store::Stage::run);
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
        .exec("CREATE TABLE mine(x); PRAGMA user_version=8");
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

}  // namespace store_tests
