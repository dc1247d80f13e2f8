#include "runners/run/finish_run.hpp"

#include <catch2/catch.hpp>
#include <ricochet/contract/said_format.hpp>

using namespace ricochet;

TEST_CASE("reasons: each once, with its cases, nothing is said of what is done without a doubt or under way") {
  StudyResults results;
  const auto add = [&](const char* id, Status status, const char* reason) -> CaseRecord& {
    CaseRecord& record = results.cases.emplace_back();
    record.id = id;
    record.status = status;
    if (*reason) record.reasons = {reason};
    return record;
  };
  add("a", Status::done, "");
  CHECK(reasons_table(results).rows.empty());
  add("b", Status::refused, "no stops");
  add("c", Status::failed, "no stops");
  add("d", Status::refused, "no stops");
  add("e", Status::failed, "under way").partial = true;
  const Table table = reasons_table(results);
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0] == Row{"refused", "no stops", 2, "b"});
  CHECK(table.rows[1] == Row{"failed", "no stops", 1, "c"});
}

TEST_CASE("reasons: doubts of one kind are one, whatever their numbers") {
  StudyResults results;
  const auto add = [&](const char* id, std::vector<Said> doubts) {
    CaseRecord& record = results.cases.emplace_back();
    record.id = id;
    record.status = Status::done;
    record.reasons = std::move(doubts);
  };
  const auto jumps = [](const char* times) {
    return said("the load jumps within a step, at t = {}", as_number(times));
  };
  const auto too_far = [](double step) { return said("a step of {:g} s takes a point too far", step); };
  add("a", {jumps("0.1 to 0.2, 0.5 to 0.6 s"), too_far(0.1)});
  add("b", {too_far(1e-5)});
  add("c", {jumps("1e-3 to 2e-3 s and 12 more")});
  const Table table = reasons_table(results);
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0] == Row{"done", "the load jumps within a step, at t = 0.1 to 0.2, 0.5 to 0.6 s", 2, "a"});
  CHECK(table.rows[1] == Row{"done", "a step of 0.1 s takes a point too far", 2, "a"});
}

namespace {

CaseRecord done(double start, double end, double impacts) {
  CaseRecord record;
  record.status = Status::done;
  record.measures = {{"energy_start", start},
                     {"energy_end", end},
                     {"energy_brought_in", start},
                     {"impacts", impacts},
                     {"microseconds_per_step", 0.4213}};
  if (start > 0) record.measures.emplace_back("energy_left", end / start);
  return record;
}

CaseRecord ended(Status status, const char* reason) {
  CaseRecord record;
  record.status = status;
  record.reasons = {reason};
  return record;
}

}  // namespace

TEST_CASE("summary: outcomes in words") {
  CHECK(outcome_text(done(12.3, 11.9, 14), "trajectory") ==
        "done: energy 12.3 J → 11.9 J (−3.3 %), 14 impacts, 0.421 µs/step");
  CHECK(outcome_text(done(2, 3, 1), "trajectory") == "done: energy 2 J → 3 J (+50.0 %), 1 impact, 0.421 µs/step");
  CHECK(outcome_text(done(1, 1 - 1e-9, 0), "trajectory") ==
        "done: energy 1 J → 1 J (−1.0e-07 %), 0 impacts, 0.421 µs/step");
  CHECK(outcome_text(done(2, 2, 0), "trajectory") == "done: energy 2 J → 2 J (unchanged), 0 impacts, 0.421 µs/step");
  CHECK(outcome_text(done(0, 2, 0), "trajectory") == "done: energy 0 J → 2 J, 0 impacts, 0.421 µs/step");
  CaseRecord driven = done(0, 2, 3);
  driven.measures[2].second = 5;
  CHECK(outcome_text(driven, "trajectory") ==
        "done: energy 0 J → 2 J, 5 J brought in by loads, 3 impacts, 0.421 µs/step");
  CHECK(outcome_text(ended(Status::done, ""), "trajectory") == "done");
  CHECK(outcome_text(ended(Status::refused, "β = 0 leaves S singular"), "trajectory") ==
        "refused: β = 0 leaves S singular");
  CHECK(outcome_text(ended(Status::diverged, "at t = 0.1 s"), "trajectory") == "diverged: at t = 0.1 s");
}

TEST_CASE("summary: only the axes that vary are shown, aligned whatever the alphabet") {
  StudyResults results;
  results.columns = {"mass", "contact", "step"};
  results.cases = {ended(Status::done, ""), ended(Status::refused, "no")};
  results.cases[0].axes = {{"mass", "µµ"}, {"contact", "none"}, {"step", 1e-5}};
  results.cases[1].axes = {{"mass", "singular"}, {"contact", "none"}, {"step", 0.25}};
  CHECK(case_table(results) ==
        "mass      step   outcome\n"
        "µµ        1e-05  done\n"
        "singular  0.25   refused: no\n");
}

TEST_CASE("summary: a study without axes names its case") {
  StudyResults results;
  results.columns = {"mass"};
  results.cases = {ended(Status::done, "")};
  results.cases[0].id = "c0123456789";
  results.cases[0].axes = {{"mass", "lumped"}};
  CHECK(case_table(results) == "case         outcome\nc0123456789  done\n");
}

TEST_CASE("summary: a stability case whose march contradicts its spectrum is said, counted and no success") {
  StudyResults results;
  results.kind = "stability";
  CaseRecord record = ended(Status::done, "");
  record.measures = {{"largest_radius", 1.0}};
  record.tables = {{"stability_observed",
                    "",
                    named_columns({"step", "closed", "behaviour"}),
                    {{1e-4, false, "stable"}, {1e-3, false, "unstable"}}}};
  results.cases = {record};
  CHECK(outcome_text(record, "stability") == "done: largest spectral radius 1");
  CHECK(results_exit_code(results) == 0);

  record.tables.front().rows.front()[2] = "diverged";
  record.measures.emplace_back("contradictions", 2);
  results.cases.push_back(record);
  CHECK(outcome_text(record, "stability") ==
        "done: largest spectral radius 1, unstable at every step marched, spectrum and march disagree without contact "
        "at 2 steps: an error of the method");
  CHECK(totals_text(results) == "2 cases: 2 done; in 1 spectrum and march disagree without contact");
  CHECK(results_exit_code(results) == 3);
}

TEST_CASE("summary: totals and exit code") {
  StudyResults results;
  results.expected_cases = 3;
  results.cases = {ended(Status::done, ""), ended(Status::refused, "x"), ended(Status::refused, "y")};
  CHECK(totals_text(results) == "3 cases: 1 done, 2 refused");
  CHECK(results_exit_code(results) == 0);
  results.cases[1].status = Status::diverged;
  CHECK(results_exit_code(results) == 3);
  results.cases[1].status = Status::failed;
  CHECK(results_exit_code(results) == 3);
  results.cases.pop_back();
  CHECK(totals_text(results) == "2 cases: 1 done, 1 failed; 1 not run yet");
  results.cases = {ended(Status::refused, "x")};
  CHECK(results_exit_code(results) == 3);
}
