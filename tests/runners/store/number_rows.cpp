#include "runners/store/number_rows.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <thread>

#include "runners/store/atomic_file.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"

using namespace ricochet;

namespace {

std::vector<ExpectedCase> expected_of(const StudyResults& results, const std::string& version) {
  std::vector<ExpectedCase> out;
  for (const CaseRecord& record : results.cases) out.push_back({record.id, version + record.id});
  return out;
}

/// Series that are longer than those read with their rows.
StudyResults long_results() {
  StudyResults results = sample_results();
  const auto repeat = [](Series& series) {
    const std::vector<double> once = series;
    for (int times = 1; times < 100; ++times) series.own().insert(series.own().end(), once.begin(), once.end());
  };
  for (Series& column : results.cases[0].curve.columns) repeat(column);
  for (NumberTable& table : results.cases[0].numbers)
    for (Series& column : table.values) repeat(column);
  return results;
}

}  // namespace

TEST_CASE("stored series: short ones are read with their rows") {
  const ScratchFolder folder;
  const StudyResults results = sample_results();
  {
    Store store(folder.path(), false);
    store.begin(results, expected_of(results, "1"));
    store.save(results.cases);
  }
  const StudyResults read = read_store(folder.path());
  std::filesystem::remove_all(folder.path());
  CHECK(read.cases[0].curve.columns == results.cases[0].curve.columns);
  CHECK(read.cases[0].numbers[1].values == results.cases[0].numbers[1].values);
}

TEST_CASE("stored series: those of a finished case are read when somebody asks, also beside a run, by many threads") {
  const ScratchFolder folder;
  const StudyResults results = long_results();
  Store store(folder.path(), false);
  store.begin(results, expected_of(results, "1"));
  store.save(results.cases);
  const StudyResults read = read_store(folder.path()), loaded = store.load();
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < 20; ++i) store.save_progress(std::to_string(i));
        for (const Series& column : read.cases[0].curve.columns) column.share();
        for (const NumberTable& table : loaded.cases[0].numbers)
          for (const Series& column : table.values) column.get();
      });
  }
  CHECK(read.cases[0].curve.columns == results.cases[0].curve.columns);
  CHECK(loaded.cases[0].numbers[1].values == results.cases[0].numbers[1].values);
}

TEST_CASE("stored series: of a case that is no longer there nothing is read in place of it") {
  const ScratchFolder folder;
  StudyResults results = long_results();
  {
    Store store(folder.path(), false);
    store.begin(results, expected_of(results, "1"));
    store.save(results.cases);
  }
  const StudyResults early = read_store(folder.path());
  const StudyResults seen = read_store(folder.path());
  CHECK(seen.cases[0].curve.columns[0].size() == 300);
  SECTION("gone") {
    Store store(folder.path(), true);
    store.begin(results, expected_of(results, "2"));
    CHECK_THROWS_AS(early.cases[0].curve.columns[0].get(), StoreError);
    CHECK_THROWS_AS(early.cases[0].numbers[0].values[0].at(0), StoreError);
  }
  SECTION("another in its place") {
    Store store(folder.path(), false);
    store.begin(results, expected_of(results, "2"));
    for (Series& column : results.cases[0].curve.columns) column.push_back(7);
    store.save(results.cases);
    CHECK_THROWS_WITH(early.cases[0].curve.columns[1].get(),
                      Catch::Contains("case c0123456789 changed while it was read"));
  }
  SECTION("the folder") {
    std::filesystem::remove_all(folder.path());
    CHECK_THROWS_AS(early.cases[0].curve.columns[0].get(), StoreError);
  }
}

TEST_CASE("stored series: what a case under way has so far is read at once, for it changes") {
  const ScratchFolder folder;
  const StudyResults results = sample_results();
  Store store(folder.path(), false);
  store.begin(results, expected_of(results, "1"));
  store.save_partial(results.cases[0]);
  const StudyResults seen = read_store(folder.path());
  CaseRecord later = results.cases[0];
  later.curve.columns = {{0, 0.1, 0.2, 0.3}, {1, 1, 1, 1}};
  store.save_partial(later);
  CHECK(seen.cases[0].curve.columns == results.cases[0].curve.columns);
}
