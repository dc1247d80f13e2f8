#include "runners/store/store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <limits>

#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"
#include "tests/runners/store/stored_study.hpp"

namespace store_tests {

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
  for (std::size_t i = 0; i < in.cases.size(); ++i) {
    check_equal(out.cases[i], in.cases[i]);
    CHECK(out.cases[i].reasons == in.cases[i].reasons);
  }
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
    const auto kept = store.begin(sample_results(), {{"c0123456789", "f1"}, {"cabcdefabcd", "other"}});
    CHECK(kept == std::set<std::string>{"c0123456789"});
    CHECK(store.load().cases.size() == 1);
  }
  SECTION("one case left the study, and the order changed") {
    const auto kept = store.begin(sample_results(), {{"new", "f3"}, {"cabcdefabcd", "f2"}});
    CHECK(kept == std::set<std::string>{"cabcdefabcd"});
    CHECK(store.load().cases.front().id == "cabcdefabcd");
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
  const std::vector<ExpectedCase> edited = {{"c0123456789", "g1"}, {"cabcdefabcd", "g2"}};
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
    CHECK(store.begin(sample_results(), kExpected) == std::set<std::string>{"c0123456789"});
    CHECK(store.returned() == 1);
    CHECK(store.aside() == 1);  // that of the edited study now
    const StudyResults back = store.load();
    REQUIRE(back.cases.size() == 1);
    check_equal(back.cases[0], sample_results().cases[0]);
    CHECK(store.begin(sample_results(), edited) == std::set<std::string>{"c0123456789"});
    check_equal(store.load().cases[0], after.cases[0]);
    // As if nothing had been aside: the order of the study, too.
    CHECK(store.begin(sample_results(), {{"other", "o"}, {"c0123456789", "f1"}}).size() == 1);
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
  results.cases[1].status = Status::failed;
  Store store(folder.path(), false);
  store.begin(results, kExpected);
  store.save_partial(results.cases[0]);
  store.save({results.cases.data() + 1, 1});
  store.begin(results, {});
  CHECK(store.aside() == 1);
  CHECK(store.begin(results, kExpected) == std::set<std::string>{"cabcdefabcd"});
  CHECK(store.failed() == std::set<std::string>{"cabcdefabcd"});
}

TEST_CASE("store: an environment goes with its cases") {
  const ScratchFolder folder;
  using Entries = std::vector<std::pair<std::string, std::string>>;
  const Entries old = sample_results().environment.entries, now = {{"program", "newer"}, {"cores", "2"}};
  fill(folder.path());
  Store store(folder.path(), false);
  store.begin(sample_results(), {{"c0123456789", "g1"}, {"cabcdefabcd", "g2"}});
  store.save(sample_results().cases);
  store.save_environment({now});
  store.begin(sample_results(), kExpected);
  CHECK(store.load().environment.entries == old);
  // One case of each.
  store.begin(sample_results(), {{"c0123456789", "f1"}, {"cabcdefabcd", "f2"}});
  store.save(sample_results().cases);
  store.begin(sample_results(), {{"c0123456789", "g1"}, {"cabcdefabcd", "f2"}});
  CHECK(store.load().environment.entries ==
        Entries{{"program", "ricochet"}, {"cores", "2"}, {"program (earlier cases)", "newer"}});
}

TEST_CASE("store: the curve file of a case goes with its row, before another takes its place") {
  const ScratchFolder folder;
  fill(folder.path());
  std::filesystem::create_directory(folder / "curves");
  const auto file = folder / "curves/c0123456789.csv";
  write_text(file, "old");
  Store store(folder.path(), false);
  store.begin(sample_results(), kExpected);
  CHECK(std::filesystem::exists(file));
  store.begin(sample_results(), {{"c0123456789", "g1"}});
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

}  // namespace store_tests
