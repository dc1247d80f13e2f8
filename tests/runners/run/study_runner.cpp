#include "runners/run/study_runner.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <ricochet/contract/errors.hpp>

#include "runners/store/atomic_file.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/run/fake_study.hpp"

using namespace ricochet;
using Catch::Contains;

TEST_CASE("run: every file of a study is there, and the exit code is 0") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const auto out = scratch / "out";
  REQUIRE(run(fake_study(4), {out, 2, false}) == 0);
  CHECK(run.runs == 4);
  for (const char* file : {"results.sqlite", "study.json", "cases.csv", "report.html", "curves/c0000abc000.csv"})
    CHECK(std::filesystem::exists(out / file));
  CHECK(read_text(out / "report.html") == "<html>4 cases</html>\n");
  CHECK_THAT(run.summary, Contains("4 cases: 4 done") && Contains("report.html") && !Contains("3 impacts"));
  CHECK_FALSE(std::filesystem::exists(out / "results.lock"));
  REQUIRE(run(fake_study(4), {out, 2, false, true}) == 0);
  CHECK_THAT(run.summary, Contains("3 impacts"));
  // stderr is a file here: no bar, no carriage return, no escape sequence.
  CHECK(run.messages.find_first_of("\r\x1b") == std::string::npos);
}

TEST_CASE("run: what was finished is not run again, whatever its status, until --fresh") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    ++run.runs;
    CaseRecord record = fake_result(one);
    record.status = one.mass.name == "odd" ? Status::diverged : Status::done;
    return record;
  };
  const RunOptions options{scratch / "out", 2, false};
  CHECK(run(fake_study(6), options) == 3);
  CHECK(run.runs == 6);
  const std::string cases = read_text(options.out / "cases.csv");
  CHECK(run(fake_study(6), options) == 3);
  CHECK(run.runs == 0);
  CHECK(read_text(options.out / "cases.csv") == cases);
  // A report of it ends as its run does.
  CHECK(rebuild_report_with(run.runner.render, options.out) == 3);
  CHECK(run(fake_study(6), {options.out, 2, true}) == 3);
  CHECK(run.runs == 6);
}

TEST_CASE("run: a kept case whose time is taken is kept, and not run") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const RunOptions options{scratch / "out", 1, false};
  run.runner.cases.time = [](const StudyCase&, const std::atomic<bool>&) { return std::optional<TimedMarch>(); };
  REQUIRE(run(fake_study(4), options) == 0);
  run.runner.cases.time = [](const StudyCase&, const std::atomic<bool>&) {
    return std::optional(TimedMarch{1e-3, 1e-3});
  };
  REQUIRE(run(fake_study(6), options) == 0);
  CHECK(run.runs == 2);
  CHECK_THAT(run.summary, Contains("(2 run now in ") && Contains(", 4 kept)"));
}

TEST_CASE("run: a data file that changes ends the run, and the cases that met it are not results") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const auto whole = run.runner.cases.run;
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>& stop) {
    if (run.runs < 2) return whole(one, stop);
    ++run.runs;
    throw InputError("/scene/load/0/force/file", "a.csv has changed since the run began");
  };
  const RunOptions options{scratch / "out", 1, false};
  CHECK(run(fake_study(6), options) == 5);
  CHECK_THAT(run.messages, Contains("a.csv has changed since the run began. This case is not kept"));
  CHECK(run.runs == 3);
  {
    const SQLite::Database store(options.out / "results.sqlite");
    SQLite::Statement rows(store, "SELECT count(*), sum(status = 'done') FROM cases");
    rows.executeStep();
    CHECK((rows.getColumn(0).getInt() == 2 && rows.getColumn(1).getInt() == 2));
  }
  run.runner.cases.run = whole;
  CHECK(run(fake_study(6), options) == 0);
  CHECK(run.runs == 4);
}

TEST_CASE("run: a changed plugin runs again the cases that use it, and only those") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  write_text(scratch / "even.so", "even 1");
  write_text(scratch / "odd.so", "odd 1");
  run.runner.libraries = [&](const StudyCase& one) {
    return std::vector<std::filesystem::path>{scratch / (one.mass.name + ".so"), "", ""};
  };
  const RunOptions options{scratch / "out", 1, false};
  REQUIRE(run(fake_study(5), options) == 0);
  write_text(scratch / "odd.so", "odd 2");
  REQUIRE(run(fake_study(5), options) == 0);
  CHECK(run.runs == 2);
}

TEST_CASE("run: an edited study keeps the results of what it was, and has them again when the edit is undone") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const RunOptions options{scratch / "out", 1, false};
  REQUIRE(run(fake_study(4), options) == 0);
  CHECK_THAT(run.messages, !Contains("aside"));
  const std::string cases = read_text(options.out / "cases.csv"), curve = "curves/c0000abc001.csv";
  const std::string before = read_text(options.out / curve);
  Study edited = fake_study(4);
  for (StudyCase& one : edited.cases) one.samples = 30;  // the same ids
  edited.cases[3].excluded = "not now";
  REQUIRE(run(edited, options) == 0);
  CHECK(run.runs == 3);
  CHECK_THAT(run.messages, Contains("4 results of an earlier version are kept aside") && Contains("--fresh"));
  CHECK(read_store(options.out).cases.size() == 4);
  CHECK(read_text(options.out / curve) != before);

  SECTION("undone") {
    REQUIRE(run(fake_study(4), options) == 0);
    CHECK(run.runs == 0);
    CHECK_THAT(run.messages, Contains("4 results that were kept aside are back") && Contains("4 finished before") &&
                                 Contains("3 results of an earlier version are kept aside"));
    CHECK(read_text(options.out / "cases.csv") == cases);
    CHECK(read_text(options.out / curve) == before);
  }
  SECTION("fresh") {
    REQUIRE(run(edited, {options.out, 1, true}) == 0);
    CHECK_THAT(run.messages, !Contains("aside"));
    REQUIRE(run(fake_study(4), options) == 0);
    CHECK(run.runs == 4);
  }
}

TEST_CASE("run: a run that ends between two versions loses neither, and no curve is that of another row") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const RunOptions options{scratch / "out", 1, false};
  REQUIRE(run(fake_study(4), options) == 0);
  const std::string cases = read_text(options.out / "cases.csv"), curve = "curves/c0000abc000.csv";
  const std::string before = read_text(options.out / curve);
  Study edited = fake_study(4);
  for (StudyCase& one : edited.cases) one.samples = 30;
  // Two cases of the edited study finish; nothing is written but the store.
  run.runner.render = [](const StudyResults&) -> std::string { throw StoreError("the program ends here"); };
  REQUIRE(run(edited, options) == 5);
  CHECK_FALSE(read_text(options.out / curve) == before);
  run.runner.render = FakeRun(scratch).runner.render;
  REQUIRE(run(fake_study(4), options) == 0);
  CHECK(run.runs == 0);
  CHECK(read_text(options.out / "cases.csv") == cases);
  CHECK(read_text(options.out / curve) == before);
  REQUIRE(run(edited, options) == 0);
  CHECK(run.runs == 0);
  CHECK_FALSE(read_text(options.out / curve) == before);
}

TEST_CASE("run: a changed study runs what changed, and shows nothing of what left") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const RunOptions options{scratch / "out", 1, false};
  REQUIRE(run(fake_study(5), options) == 0);
  Study study = fake_study(5);
  study.cases[1].duration = 2;
  study.cases.erase(study.cases.begin() + 3);
  REQUIRE(run(study, options) == 0);
  CHECK(run.runs == 1);
  CHECK(read_store(options.out).cases.size() == 4);
  CHECK_FALSE(std::filesystem::exists(options.out / "curves/c0000abc003.csv"));
  CHECK(std::filesystem::exists(options.out / "curves/c0000abc004.csv"));
  CHECK(read_text(options.out / "cases.csv").find("c0000abc003") == std::string::npos);
}

TEST_CASE("run: excluded cases are rows with their reason, and nothing runs for them") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  Study study = fake_study(3);
  study.cases[1].excluded = "an hour each";
  const RunOptions options{scratch / "out", 2, false};
  CHECK(run(study, options) == 0);
  CHECK(run.runs == 2);
  const CaseRecord record = read_store(options.out).cases[1];
  CHECK(record.status == Status::refused);
  CHECK(record.reason() == "excluded: an hour each");
  CHECK(record.axes == study.cases[1].axes);
}

TEST_CASE("run: what a case throws is its row, and the others go on") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  run.runner.cases.run = [](const StudyCase& one, const std::atomic<bool>&) {
    if (one.id.back() == '0') throw InputError("/scene/stops/lower", "the stops cross at x = 0.3");
    if (one.id.back() == '1') throw std::runtime_error("out of luck");
    if (one.id.back() == '2') throw std::bad_alloc();
    if (one.id.back() == '3') throw 42;
    return fake_result(one);
  };
  const RunOptions options{scratch / "out", 2, false};
  CHECK(run(fake_study(5), options) == 3);
  const std::vector<CaseRecord> cases = read_store(options.out).cases;
  REQUIRE(cases.size() == 5);
  CHECK(cases[0].reason() == "at /scene/stops/lower: the stops cross at x = 0.3");
  CHECK(cases[1].reason() == "out of luck");
  CHECK(cases[2].reason() == "not enough memory");
  for (int i = 0; i < 4; ++i) CHECK(cases[static_cast<std::size_t>(i)].status == Status::failed);
  CHECK(cases[4].status == Status::done);
  CHECK_THAT(run.summary, Contains("1 done, 4 failed") && Contains("exit code 3"));
}

TEST_CASE("run: where the input of every case is wrong the study is, and no case runs") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const auto wrong = [](bool all) {
    return [all](const StudyCase& one) -> CasePlan {
      if (all || one.id.back() == '0') throw InputError("/scene/initial/equilibrium", "friction leaves it open");
      return {};
    };
  };
  run.runner.plan = wrong(true);
  CHECK_THROWS_AS(run(fake_study(3), {scratch / "all", 2, false}), InputError);
  CHECK(run.runs == 0);
  run.runner.plan = wrong(false);
  CHECK(run(fake_study(3), {scratch / "some", 2, false}) == 0);
  CHECK(run.runs == 3);
}

TEST_CASE("run: longest predicted first, on one thread as predicted") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  std::vector<std::string> order;
  run.runner.plan = [](const StudyCase& one) {
    if (one.id.back() == '4') throw InputError("/mesh", "no prediction");  // runs last, with its own message
    CasePlan plan;
    plan.predicted_seconds = one.id.back() == '2' ? 10 : 1 + (one.id.back() - '0');
    return plan;
  };
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    order.push_back(one.id.substr(one.id.size() - 1));
    return fake_result(one);
  };
  REQUIRE(run(fake_study(5), {scratch / "out", 1, false}) == 0);
  CHECK(order == std::vector<std::string>{"2", "3", "1", "0", "4"});
}

TEST_CASE("run: the number of threads changes nothing but the time") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  REQUIRE(run(fake_study(30), {scratch / "one", 1, false}) == 0);
  REQUIRE(run(fake_study(30), {scratch / "four", 4, false}) == 0);
  CHECK(read_text(scratch / "one/cases.csv") == read_text(scratch / "four/cases.csv"));
}

TEST_CASE("run: never more cases at once than --jobs") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  std::atomic<int> at_once{0}, most{0};
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    const int now = ++at_once;
    for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
    }
    ::usleep(2000);
    --at_once;
    return fake_result(one);
  };
  REQUIRE(run(fake_study(30), {scratch / "out", 3, false}) == 0);
  CHECK(most <= 3);
}

TEST_CASE("run: cases on several threads show what they have so far, and none fails another") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  CheckpointStore checkpoints;
  run.runner.cases.open = [&](CheckpointStore opened, const std::atomic<bool>&) { checkpoints = std::move(opened); };
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    for (int k = 0; k < 10; ++k) {
      CaseRecord partial = fake_result(one);
      partial.id = one.id;
      partial.axes = one.axes;
      checkpoints.show(partial);
    }
    return fake_result(one);
  };
  REQUIRE(run(fake_study(12), {scratch / "out", 4, false}) == 0);
  const StudyResults results = read_store(scratch / "out");
  REQUIRE(results.cases.size() == 12);
  for (const CaseRecord& record : results.cases) {
    CHECK(record.status == Status::done);
    CHECK_FALSE(record.partial);
  }
}

TEST_CASE("run: a folder without write permission") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const auto out = scratch / "out";
  std::filesystem::create_directory(out);
  ::chmod(out.c_str(), 0555);
  ::chmod(scratch.path().c_str(), 0755);
  // root may write anywhere: it tries as somebody else. The message files are opened before.
  constexpr uid_t nobody = 65534;
  const bool root = ::geteuid() == 0;
  std::string refused;
  if (root) REQUIRE(::seteuid(nobody) == 0);
  try {
    const Store store(out, false);
  } catch (const std::exception& error) {
    refused = error.what();
  }
  if (root) REQUIRE(::seteuid(0) == 0);
  CHECK_THAT(refused, Contains(out.string()) && Contains("not writable") && Contains("Permission denied"));
  CHECK(std::filesystem::is_empty(out));
  write_text(scratch / "file", "in the way");
  CHECK(run(fake_study(2), {scratch / "file", 1, false}) == 5);
  CHECK(run.runs == 0);
  CHECK_THAT(run.messages, Contains("ricochet: ") && Contains((scratch / "file").string()));
}

TEST_CASE("run: results of another study in the folder are an error, not a loss") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const RunOptions options{scratch / "out", 1, false};
  REQUIRE(run(fake_study(2), options) == 0);
  Study other = fake_study(2);
  other.name = "other";
  CHECK(run(other, options) == 5);
  CHECK(read_store(options.out).cases.size() == 2);
}

TEST_CASE("run: the environment says when kept cases were computed elsewhere") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const RunOptions options{scratch / "out", 1, false};
  run.runner.environment = [] { return Environment{{{"processor", "old"}, {"started", "yesterday"}}}; };
  REQUIRE(run(fake_study(2), options) == 0);
  run.runner.environment = [] { return Environment{{{"processor", "new"}, {"started", "today"}}}; };
  REQUIRE(run(fake_study(3), options) == 0);
  using Entries = std::vector<std::pair<std::string, std::string>>;
  const Entries expected = {{"processor", "new"}, {"started", "today"}, {"processor (earlier cases)", "old"}};
  CHECK(read_store(options.out).environment.entries == expected);
  REQUIRE(run(fake_study(3), options) == 0);  // nothing ran: nothing to say
  CHECK(read_store(options.out).environment.entries == expected);
}

TEST_CASE("run: the view of the store is cases.csv") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const auto out = scratch / "out";
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    CaseRecord record = fake_result(one);
    if (one.id.back() == '1') record.measures.emplace_back("a \"quoted\" name", 0.5);
    return record;
  };
  Study study = fake_study(3);
  study.columns.push_back("it's");
  study.cases[2].axes.emplace_back("it's", nullptr);
  study.cases[1].axes.emplace_back("it's", "so");
  REQUIRE(run(study, {out, 1, false}) == 0);
  const Table cases = cases_table(read_store(out));
  SQLite::Database database((out / "results.sqlite").string());
  SQLite::Statement view(database, "SELECT * FROM v_cases");
  REQUIRE(view.getColumnCount() == static_cast<int>(cases.columns.size()));
  for (const Row& row : cases.rows) {
    REQUIRE(view.executeStep());
    for (int c = 0; c < view.getColumnCount(); ++c) {
      const Cell& cell = row[static_cast<std::size_t>(c)];
      INFO(cases.columns[static_cast<std::size_t>(c)].name);
      CHECK(view.getColumnName(c) == cases.columns[static_cast<std::size_t>(c)].name);
      if (const auto number = cell.number())
        CHECK(view.getColumn(c).getDouble() == *number);
      else
        CHECK(view.getColumn(c).getString() == cell.text());
    }
  }
  CHECK_FALSE(view.executeStep());
}

TEST_CASE("report and export: from the store alone") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const auto out = scratch / "out";
  REQUIRE(run(fake_study(3), {out, 1, false}) == 0);
  const std::string cases = read_text(out / "cases.csv");
  std::filesystem::remove(out / "cases.csv");
  std::filesystem::remove_all(out / "curves");
  CHECK(rebuild_report_with(run.runner.render, out) == 0);
  CHECK(read_text(out / "cases.csv") == cases);
  CHECK(std::filesystem::exists(out / "curves/c0000abc002.csv"));
  CHECK(export_tables(out, scratch / "tables") == 0);
  CHECK(read_text(scratch / "tables/cases.csv") == cases);
  for (const char* table : {"measures", "left_out", "notes", "environment", "curves/c0000abc000"})
    CHECK(std::filesystem::exists(scratch / ("tables/" + std::string(table) + ".csv")));
  CHECK(rebuild_report_with(run.runner.render, scratch / "absent") == 5);
  CHECK(export_tables(scratch / "absent", scratch / "tables") == 5);
}
