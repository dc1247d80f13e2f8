// What a store holds is what was stored, or it is named and left out.
#include "runners/store/checksums.hpp"

#include "runners/store/read_store.hpp"
#include "runners/table/text.hpp"
#include "tests/runners/store/stored_study.hpp"

namespace store_tests {
namespace {

void change(const std::filesystem::path& folder, const std::string& sql) {
  SQLite::Database database(folder / "results.sqlite", SQLite::OPEN_READWRITE);
  database.exec("PRAGMA foreign_keys=OFF; PRAGMA ignore_check_constraints=ON");
  database.exec(sql);
}

std::string read_error(const std::filesystem::path& folder) {
  try {
    read_store(folder);
  } catch (const StoreError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("checksums: each word, and each change of length, changes them") {
  const std::string text = "0123456789abcdef";
  const std::string whole = checksum_of(text);
  CHECK(whole.size() == 16);
  for (std::size_t byte = 0; byte < text.size(); ++byte)
    for (unsigned bit = 0; bit < 8; ++bit) {
      std::string other = text;
      other[byte] = static_cast<char>(static_cast<unsigned char>(other[byte]) ^ (1U << bit));
      CHECK(checksum_of(other) != whole);
    }
  CHECK(checksum_of(text + std::string(1, '\0')) != whole);
  CHECK(checksum_of("") != checksum_of(std::string(1, '\0')));
}

TEST_CASE("checksums: a changed, lost or added row of a case names it, and keeps the others") {
  for (const std::string sql : {
           "UPDATE measures SET value = value * (1 + 1e-15) WHERE name = 'energy_start'",
           "UPDATE measures SET name = 'impact' WHERE name = 'impacts'",
           "UPDATE axes SET value = '\"lumped\"' WHERE case_id = 'c0123456789' AND name = 'mass'",
           "UPDATE cases SET reason = 'x' WHERE id = 'c0123456789'",
           "UPDATE cases SET status = 'failed' WHERE id = 'c0123456789'",
           "UPDATE cases SET status = '<b>' WHERE id = 'c0123456789'",
           "UPDATE cases SET position = 9 WHERE id = 'c0123456789'",
           "UPDATE cases SET steps = steps + 1 WHERE id = 'c0123456789'",
           "UPDATE notes SET note = note || ' '",
           "UPDATE left_out SET item = 'x'",
           "UPDATE curves SET series = zeroblob(24) WHERE position = 1",
           "UPDATE case_numbers SET series = zeroblob(24) WHERE part = 2",
           "UPDATE case_numbers SET part = 1000000 WHERE part = 2",
           "UPDATE case_numbers SET part = -1 WHERE part = 2",
           "UPDATE case_numbers SET words = '[1' WHERE part = 1",
           "DELETE FROM case_numbers WHERE part = 1",
           "DELETE FROM curves WHERE position = 0",
           "INSERT INTO notes VALUES('c0123456789', 7, 'never said')",
           "DELETE FROM cases WHERE id = 'c0123456789'",
           "UPDATE cases SET id = '../../X' WHERE id = 'c0123456789'",
       }) {
    INFO(sql);
    const ScratchFolder folder;
    fill(folder.path());
    change(folder.path(), sql);
    const StudyResults read = read_what_is_whole(folder.path());
    REQUIRE(read.cases.size() == 1);
    check_equal(read.cases[0], sample_results().cases[1]);
    CHECK(read.damage.cases.contains("c0123456789"));
    CHECK_THAT(read_error(folder.path()), Catch::Contains("this store is damaged in ") &&
                                              Catch::Contains("case c0123456789") &&
                                              Catch::Contains("computes that again, and keeps the rest"));
    // A run computes it again; all else stays.
    Store store(folder.path(), false);
    CHECK(store.begin(sample_results(), kExpected) == std::set<std::string>{"cabcdefabcd"});
    CHECK_FALSE(store.damaged().empty());
    const std::vector<CaseRecord> again = {sample_results().cases[0]};
    store.save(again);
    CHECK(store.load().cases.size() == 2);
  }
}

TEST_CASE("checksums: what is said of the study is written again, a damaged environment is left out") {
  const ScratchFolder folder;
  fill(folder.path());
  for (const std::string key : {"name", "question", "resolved", "columns", "expected_cases"}) {
    change(folder.path(), "UPDATE study SET value = replace(value, 'a', 'b') || ' ' WHERE key = '" + key + "'");
    CHECK_THAT(read_error(folder.path()), Catch::Contains("what it says of the study is damaged (" + key + ")"));
    CHECK(open_error(folder.path()).empty());
    CHECK(read_error(folder.path()).empty());
  }
  change(folder.path(), "UPDATE environment SET value = 'another'");
  CHECK_THAT(read_error(folder.path()), Catch::Contains("damaged in the environment"));
  CHECK(read_what_is_whole(folder.path()).cases.size() == 2);
  // A run keeps nothing of it.
  CHECK(open_error(folder.path()).empty());
  const StudyResults kept = read_store(folder.path());
  REQUIRE(kept.environment.entries.size() == 1);
  CHECK(kept.environment.entries[0] == std::pair<std::string, std::string>("environment", "damaged, left out"));
}

TEST_CASE("checksums: a run compares what it finds once, and a reader always") {
  const ScratchFolder folder;
  fill(folder.path());
  Store store(folder.path(), false);
  CHECK(store.begin(sample_results(), kExpected).size() == 2);
  change(folder.path(), "UPDATE measures SET value = 7 WHERE name = 'impacts'");
  // What begin() saw stands: the lock keeps other runs away.
  CHECK(store.load().damage.cases.empty());
  CHECK_THAT(read_error(folder.path()), Catch::Contains("case c0123456789"));
  CHECK(store.begin(sample_results(), kExpected) == std::set<std::string>{"cabcdefabcd"});
}

TEST_CASE("checksums: a motion that is damaged is not there, one of an earlier program is") {
  const ScratchFolder folder;
  Store store(folder.path(), false);
  store.begin(sample_results(), kExpected);
  store.save_motion("key", "content");
  store.save_motion("key", "content of today");
  CHECK(store.motion("key") == "content of today");
  change(folder.path(), "UPDATE motions SET content = 'content of tolay'");
  CHECK(store.motion("key").empty());
  change(folder.path(), "DELETE FROM motion_sums");
  CHECK(store.motion("key") == "content of tolay");
}

TEST_CASE("checksums: a store of an earlier program is checked for what cannot be") {
  for (const std::string sql :
       {"UPDATE cases SET id = '../../X' WHERE id = 'c0123456789'", "UPDATE case_numbers SET part = 5 WHERE part = 2",
        "UPDATE case_numbers SET name = '../X'", "UPDATE case_numbers SET series = zeroblob(8) WHERE part = 1",
        "UPDATE axes SET value = '{' WHERE case_id = 'c0123456789'",
        "UPDATE cases SET status = '<b>' WHERE id = 'c0123456789'"}) {
    INFO(sql);
    const ScratchFolder folder;
    fill(folder.path());
    change(folder.path(), sql +
                              "; DROP TABLE sums; DROP TABLE aside_sums; DROP TABLE motion_sums; DROP TABLE reasons; "
                              "DROP TABLE aside_reasons; PRAGMA user_version=7; "
                              "DELETE FROM study WHERE key = 'checksums'");
    const StudyResults read = read_what_is_whole(folder.path());
    REQUIRE(read.cases.size() == 1);
    CHECK(read.damage.cases.size() == 1);
  }
}

TEST_CASE("checksums: texts of a store are read as they may be shown") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  results.question = "\x1b[2J?";
  results.cases[1].reasons = {"caf\xE9 \x1b]0;X\a \u202E."};
  results.cases[0].notes = {"\r\n"};
  {
    Store store(folder.path(), false);
    store.begin(results, kExpected);
    store.save(results.cases);
  }
  const StudyResults read = read_store(folder.path());
  CHECK(read.question == "<U+001B>[2J?");
  CHECK(read.cases[1].reason() == "caf\uFFFD <U+001B>]0;X<U+0007> <U+202E>.");
  CHECK(read.cases[0].notes[0] == "<U+000D>\n");
  SQLite::Database database(folder / "results.sqlite");
  CHECK(is_plain(database.execAndGet("SELECT reason FROM cases WHERE reason != ''").getString()));
}

}  // namespace store_tests
