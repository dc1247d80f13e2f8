#include "runners/store/environments.hpp"

#include <catch2/catch.hpp>

#include "runners/run/compare_studies.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/run/fake_study.hpp"
#include "tests/runners/store/sample_results.hpp"

using namespace ricochet;

TEST_CASE("arithmetics: a case keeps that of the run that computed it, also aside and when it is saved again") {
  const ScratchFolder folder;
  StudyResults results = sample_results();
  results.cases[1].status = "done";
  const std::vector<ExpectedCase> both = {{results.cases[0].id, "f1"}, {results.cases[1].id, "f2"}};
  {
    Store store(folder.path(), false);
    store.begin(results, both, "aaaa");
    store.save({results.cases.data(), 1});
  }
  Store store(folder.path(), false);
  store.begin(results, both, "bbbb");
  store.save({results.cases.data() + 1, 1});
  StudyResults seen = store.load();
  CHECK(seen.cases[0].arithmetic == "aaaa");
  CHECK(seen.cases[1].arithmetic == "bbbb");
  CHECK(environment_entry(seen.environment, kArithmetic) ==
        "2 that differ in last digits: aaaa (1 case), bbbb (1 case)");
  store.save(seen.cases);  // as when they are timed
  store.begin(results, {}, "bbbb");
  store.begin(results, both, "bbbb");
  seen = store.load();
  CHECK(seen.cases[0].arithmetic == "aaaa");
  // What runs say of themselves is not repeated.
  store.save_environment({{{"program", "p"}, {kArithmetic, "bbbb"}, {"arithmetic (earlier cases)", "aaaa"}}});
  seen = store.load();
  CHECK(seen.environment.entries.size() == 2);
  CHECK(environment_entry(seen.environment, kArithmetic).starts_with("2 that differ"));
}

TEST_CASE("arithmetics: what a case left under way is found by runs of the same arithmetic alone") {
  const ScratchFolder folder;
  const StudyResults results = sample_results();
  Store store(folder.path(), false);
  store.begin(results, {}, "aaaa");
  store.save_motion("orbits", "of a");
  store.begin(results, {}, "bbbb");
  CHECK(store.motion("orbits").empty());
  store.save_motion("orbits", "of b");
  CHECK(read_motion(folder.path(), "orbits", "aaaa") == "of a");
  store.begin(results, {}, "aaaa");
  CHECK(store.motion("orbits") == "of a");
}

TEST_CASE("arithmetics: finished cases of another one are kept, and a comparison says that two made the results") {
  const ScratchFolder scratch;
  const Study study = fake_study(4);
  FakeRun run(scratch);
  run.runner.arithmetic = "aaaa";
  REQUIRE(run(study, {scratch / "one", 1, false}) == 0);
  run.runner.cases.run = [&, done = 0](const StudyCase& one, const std::atomic<bool>& stop) mutable {
    if (++done > 2) const_cast<std::atomic<bool>&>(stop) = true;
    return fake_result(one);
  };
  CHECK(run(study, {scratch / "two", 1, false}) == 130);
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    ++run.runs;
    return fake_result(one);
  };
  run.runner.arithmetic = "bbbb";
  CHECK(run(study, {scratch / "two", 1, false}) == 0);
  CHECK(run.runs == 1);
  CHECK_THAT(run.messages, Catch::Contains("3 cases were computed with other last digits"));
  const StudyComparison found = compare_studies(read_store(scratch / "one"), read_store(scratch / "two"));
  REQUIRE(found.environment.size() == 1);
  CHECK(found.environment[0].where == kArithmetic);
  CHECK(found.environment[0].a == "aaaa");
  CHECK(found.environment[0].b == "2 that differ in last digits: aaaa (3 cases), bbbb (1 case)");
}
