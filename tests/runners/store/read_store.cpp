#include "runners/store/read_store.hpp"

#include "tests/runners/store/stored_study.hpp"

using namespace ricochet;

TEST_CASE("store reader: a case read alone is saved again as the same rows, and what is not finished is not listed") {
  const ScratchFolder scratch;
  StudyResults results = sample_results();
  results.part = {2, 3};
  const std::vector<ExpectedCase> expected = {
      {results.cases[0].id, "f1"}, {results.cases[1].id, "f2"}, {"00000partial", "f3"}};
  {
    Store store(scratch / "one", false);
    store.begin(results, expected, "aaaa");
    store.save(results.cases);
    CaseRecord partial = results.cases[0];
    partial.id = "00000partial";
    store.save_partial(partial);
    store.save_environment(results.environment);
    store.save_motion("key", "content");
  }
  const StoreReader reader(scratch / "one");
  const StudyResults head = reader.head();
  CHECK(head.cases.empty());
  CHECK(head.study == results.study);
  CHECK(head.part == StudyPart{2, 3});
  CHECK(head.environment.entries == results.environment.entries);
  const auto finished = reader.finished();
  REQUIRE(finished.size() == 2);
  CHECK(finished[0].fingerprint == "f1");
  CHECK(finished[1].refused);
  CHECK(finished[0].arithmetic == "aaaa");
  CHECK(reader.motion_keys("aaaa") == std::vector<std::string>{"key"});
  CHECK(reader.motion_keys("bbbb").empty());
  CHECK(reader.motion("key", "aaaa") == "content");
  CHECK_THROWS_AS(reader.read("no such one"), StoreError);

  Store other(scratch / "other", false);
  other.begin(results, expected, "bbbb");
  for (const auto& one : finished) {
    const CaseRecord record = reader.read(one.id);
    other.save({&record, 1});
  }
  const StudyResults copied = other.load(), whole = read_store(scratch / "one");
  REQUIRE(copied.cases.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    store_tests::check_equal(copied.cases[i], whole.cases[i]);
    CHECK(copied.cases[i].arithmetic == whole.cases[i].arithmetic);
    CHECK(copied.cases[i].tables.size() == whole.cases[i].tables.size());
  }
}
