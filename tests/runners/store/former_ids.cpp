// Stores of programs whose ids were ten digits alone.
#include "runners/kinds/stored_study.hpp"
#include "runners/store/read_store.hpp"
#include "tests/runners/store/stored_study.hpp"

using namespace ricochet;
using namespace store_tests;

namespace {

/// The store of the sample study as an earlier program left it: its curve lies beside it.
void make_former(const std::filesystem::path& folder) {
  fill(folder);
  SQLite::Database database(folder / "results.sqlite", SQLite::OPEN_READWRITE);
  database.exec(
      "DROP TABLE sums; DROP TABLE aside_sums; DROP TABLE motion_sums; DROP TABLE reasons; DROP TABLE aside_reasons; "
      "PRAGMA user_version=7");
  for (const char* table : {"axes", "measures", "left_out", "notes", "curves", "case_tables", "case_numbers"})
    database.exec(std::string("UPDATE ") + table + " SET case_id = substr(case_id, 2)");
  database.exec("UPDATE cases SET id = substr(id, 2)");
  std::filesystem::create_directories(folder / "curves");
  write_text(folder / "curves/0123456789.csv", "t\n0\n");
}

}  // namespace

TEST_CASE("former ids: a store of earlier programs is read under the ids of today") {
  const ScratchFolder former, today;
  make_former(former.path());
  fill(today.path());
  const StudyResults old_one = read_store(former.path()), new_one = read_store(today.path());
  REQUIRE(old_one.cases.size() == new_one.cases.size());
  for (std::size_t i = 0; i < old_one.cases.size(); ++i) {
    CHECK(old_one.cases[i].id.front() == 'c');
    check_equal(old_one.cases[i], new_one.cases[i]);
  }
  // By its id of today, that of then, or the beginning of either.
  for (const char* asked : {"c0123456789", "0123456789", "01234", "c0123"})
    CHECK(find_case(old_one, asked).id == "c0123456789");
  const StoreReader reader(former.path());
  CHECK(reader.finished().front().id == "c0123456789");
  check_equal(reader.read("c0123456789"), new_one.cases.front());
}

TEST_CASE("former ids: a store of earlier programs is resumed, and keeps what it has under the ids of today") {
  const ScratchFolder folder;
  make_former(folder.path());
  Store store(folder.path(), false);
  CHECK(store.begin(sample_results(), kExpected) == std::set<std::string>{"c0123456789", "cabcdefabcd"});
  CHECK(store.returned() == 0);
  CHECK(store.aside() == 0);
  check_equal(store.load().cases.front(), sample_results().cases.front());
  CHECK(std::filesystem::exists(folder / "curves/c0123456789.csv"));
  CHECK_FALSE(std::filesystem::exists(folder / "curves/0123456789.csv"));
}

TEST_CASE("former ids: cases that earlier programs set aside come back") {
  const ScratchFolder folder;
  make_former(folder.path());
  {
    Store store(folder.path(), false);
    store.begin(sample_results(), {{"c0123456789", "g1"}, {"cabcdefabcd", "g2"}});
    CHECK(store.aside() == 1);
  }
  {
    SQLite::Database database(folder / "results.sqlite", SQLite::OPEN_READWRITE);
    database.exec("UPDATE aside_cases SET id = substr(id, 2)");
  }
  Store store(folder.path(), false);
  CHECK(store.begin(sample_results(), kExpected).count("c0123456789") == 1);
  CHECK(store.returned() == 1);
}
