#include "runners/run/finish_run.hpp"

#include <catch2/catch.hpp>

using namespace ricochet;

TEST_CASE("reasons: each once, with its cases, nothing is said of what is done without a doubt or under way") {
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

TEST_CASE("reasons: doubts of one kind are one, whatever their numbers") {
  StudyResults results;
  const auto add = [&](const char* id, const char* reason) {
    CaseRecord& record = results.cases.emplace_back();
    record.id = id;
    record.status = "done";
    record.reason = reason;
  };
  add("a", "the load jumps within a step, at t = 0.1 to 0.2, 0.5 to 0.6 s; a step of 0.1 s takes a point too far");
  add("b", "a step of 1e-05 s takes a point too far");
  add("c", "the load jumps within a step, at t = 1e-3 to 2e-3 s and 12 more");
  const Table table = reasons_table(results);
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0] == Row{"done", "the load jumps within a step, at t = 0.1 to 0.2, 0.5 to 0.6 s", 2, "a"});
  CHECK(table.rows[1] == Row{"done", "a step of 0.1 s takes a point too far", 2, "a"});
}
