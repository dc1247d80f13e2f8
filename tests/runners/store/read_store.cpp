#include "runners/store/read_store.hpp"

#include <catch2/catch.hpp>

#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"

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
  CHECK(finished[1].status == "refused");
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
    const CaseRecord &a = whole.cases[i], &b = copied.cases[i];
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
    CHECK(a.arithmetic == b.arithmetic);
    CHECK(a.curve.names == b.curve.names);
    CHECK(a.curve.columns == b.curve.columns);
    CHECK(a.tables.size() == b.tables.size());
    REQUIRE(a.numbers.size() == b.numbers.size());
    for (std::size_t k = 0; k < a.numbers.size(); ++k) {
      CHECK(a.numbers[k].name == b.numbers[k].name);
      CHECK(a.numbers[k].exported == b.numbers[k].exported);
      CHECK(a.numbers[k].words == b.numbers[k].words);
      CHECK(a.numbers[k].values.size() == b.numbers[k].values.size());
    }
  }
}
