#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/store/sample_results.hpp"

using namespace ricochet;

namespace store_tests {

inline const std::vector<ExpectedCase> kExpected = {{"c0123456789", "f1"}, {"cabcdefabcd", "f2"}};

inline void fill(const std::filesystem::path& folder) {
  Store store(folder, false);
  const StudyResults results = sample_results();
  store.begin(results, kExpected);
  store.save_environment(results.environment);
  store.save(results.cases);
}

inline std::string open_error(const std::filesystem::path& folder, bool fresh = false) {
  try {
    Store store(folder, fresh);
    store.begin(sample_results(), kExpected);
  } catch (const StoreError& error) {
    return error.what();
  }
  return "";
}

inline void check_equal(const CaseRecord& a, const CaseRecord& b) {
  CHECK(a.id == b.id);
  CHECK(a.axes == b.axes);
  CHECK(a.status == b.status);
  CHECK(a.reason() == b.reason());
  CHECK(a.excluded == b.excluded);
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

inline int count(const std::filesystem::path& folder, const std::string& what) {
  const SQLite::Database database(folder / "results.sqlite");
  SQLite::Statement rows(database, "SELECT count(*) FROM " + what);
  rows.executeStep();
  return rows.getColumn(0).getInt();
}

}  // namespace store_tests
