#include "runners/run/reasons_table.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("reasons: each once, with its cases, nothing is said of what is done or under way") {
  StudyResults results;
  const auto add = [&](const char* id, const char* status, const char* reason) -> CaseRecord& {
    CaseRecord& record = results.cases.emplace_back();
    record.id = id;
    record.status = status;
    record.reason = reason;
    return record;
  };
  add("a", "done", "");
  CHECK(reasons_table(results).rows.empty());
  add("b", "refused", "no stops");
  add("c", "failed", "no stops");
  add("d", "refused", "no stops");
  add("e", "failed", "under way").partial = true;
  const Table table = reasons_table(results);
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0] == Row{"refused", "no stops", 2, "b"});
  CHECK(table.rows[1] == Row{"failed", "no stops", 1, "c"});
}
