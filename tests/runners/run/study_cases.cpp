#include "runners/run/study_cases.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "runners/store/fingerprint.hpp"
#include "runners/store/store.hpp"
#include "tests/runners/run/fake_study.hpp"

using namespace ricochet;
using Catch::Contains;

namespace {

/// What the cases of a fake study are taken to cost: a few dear ones, equals, one whose cost is not known.
std::map<std::string, double> costs_of(const Study& study, double last_digits = 0) {
  std::map<std::string, double> seconds;
  for (std::size_t i = 0; i + 1 < study.cases.size(); ++i)
    seconds[study.cases[i].id] =
        (i % 5 == 0 ? 100.0 / static_cast<double>(i + 1) : 0.3) * (i % 2 == 0 ? 1 + last_digits : 1 - last_digits);
  return seconds;
}

std::vector<std::string> ids_of(const std::vector<const StudyCase*>& cases) {
  std::vector<std::string> ids;
  for (const StudyCase* one : cases) ids.push_back(one->id);
  return ids;
}

}  // namespace

TEST_CASE("parts: each case is in one part, in the study's order, and parts cost about the same") {
  const Study study = fake_study(23);
  const auto seconds = costs_of(study);
  double dearest = 0;
  for (const auto& [id, cost] : seconds) dearest = std::max(dearest, cost);
  for (const int of : {1, 2, 5, 23}) {
    std::set<std::string> met;
    double least = 1e9, most = 0;
    for (int number = 1; number <= of; ++number) {
      const auto cases = cases_of_part(study, {number, of}, seconds);
      CHECK(std::is_sorted(cases.begin(), cases.end()));
      double cost = 0;
      for (const StudyCase* one : cases) {
        CHECK(met.insert(one->id).second);
        if (seconds.count(one->id)) cost += seconds.at(one->id);
      }
      CHECK(cases.size() >= static_cast<std::size_t>(23 / of));
      least = std::min(least, cost);
      most = std::max(most, cost);
    }
    CHECK(met.size() == 23);
    // Of two hands that are dealt from a sorted deck each card of one is above the next one of the other.
    CHECK(most - least <= dearest);
  }
}

TEST_CASE("parts: the last digits of a processor deal no other cases") {
  const Study study = fake_study(23);
  for (int number = 1; number <= 4; ++number) {
    const auto here = ids_of(cases_of_part(study, {number, 4}, costs_of(study)));
    CHECK(here == ids_of(cases_of_part(study, {number, 4}, costs_of(study, 1e-12))));
    CHECK(here == ids_of(cases_of_part(study, {number, 4}, costs_of(study, -1e-12))));
  }
}

TEST_CASE("parts: of cases that cost the same none has those of one method alone, however many there are") {
  Study study = fake_study(64);  // two masses in turn
  for (StudyCase& one : study.cases) one.id = content_hash(one.id).substr(0, 10);
  for (const int of : {2, 4, 8})
    for (int number = 1; number <= of; ++number) {
      std::set<std::string> masses;
      for (const StudyCase* one : cases_of_part(study, {number, of}, {})) masses.insert(one->mass.name);
      CHECK(masses.size() == 2);
    }
}

TEST_CASE("parts: each has a case to run, and more parts than such cases are refused") {
  Study study = fake_study(6);
  for (const std::size_t i : {std::size_t{0}, std::size_t{3}}) study.cases[i].excluded = "not now";
  CHECK_NOTHROW(check_part(study, {4, 4}));
  for (int number = 1; number <= 4; ++number) {
    const auto cases = cases_of_part(study, {number, 4}, {});
    CHECK(std::any_of(cases.begin(), cases.end(), [](const StudyCase* one) { return !one->excluded; }));
  }
  CHECK_THROWS_WITH(check_part(study, {1, 5}), Contains("fake: this study has 4 cases to run: at most 4 parts, not 5"));
}

TEST_CASE("parts: a run of one has its cases alone, says so, and goes on as itself only") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  const Study study = fake_study(7);
  RunOptions options{scratch / "out", 1};
  options.part = {2, 3};
  REQUIRE(run(study, options) == 0);
  CHECK(run.runs == 2);
  CHECK_THAT(run.summary, Contains("part 2 of 3: 2 cases: 2 done") && !Contains("not run yet"));
  CHECK_THAT(run.messages, Contains("fake, part 2 of 3: 2 cases, 0 finished before, 2 to plan and run"));
  const StudyResults part = read_store(options.out);
  CHECK(part.part == StudyPart{2, 3});
  CHECK(part.expected_cases == 2);
  CHECK(part.study == study.resolved);
  CHECK(part.cases.at(0).id == study.cases[1].id);
  CHECK(part.cases.at(1).id == study.cases[4].id);

  REQUIRE(run(study, options) == 0);
  CHECK(run.runs == 0);
  const std::string before = read_text(options.out / "results.sqlite");
  RunOptions other = options;
  for (const StudyPart& wanted : {StudyPart{1, 3}, StudyPart{2, 4}, StudyPart{}}) {
    other.part = wanted;
    CHECK_THROWS_WITH(run(study, other), Contains("this folder holds part 2 of 3 of \"fake\"") && Contains("--out") &&
                                             Contains("--fresh") && Contains("ricochet merge"));
    CHECK(read_text(options.out / "results.sqlite") == before);
  }
  other.fresh = true;
  REQUIRE(run(study, other) == 0);
  CHECK(run.runs == 7);
  other = options;
  CHECK_THROWS_WITH(run(study, other), Contains("holds all the cases of \"fake\", and part 2 of 3 was asked for"));
}

TEST_CASE("parts: a part that cannot be leaves no folder") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  RunOptions options{scratch / "out", 1};
  options.part = {1, 4};
  CHECK_THROWS_AS(run(fake_study(3), options), PartRefused);
  CHECK_FALSE(std::filesystem::exists(options.out));
  CHECK(default_folder("fake", {}) == "results/fake");
  CHECK(default_folder("fake", {3, 64}) == "results/fake-part-3-of-64");
}

TEST_CASE("parts: a case of another part whose cost cannot be told, or whose methods fail, is no matter of this one") {
  const ScratchFolder scratch;
  FakeRun run(scratch);
  run.runner.plan = [](const StudyCase& one) -> CasePlan {
    if (one.id.back() == '0') throw std::runtime_error("no plan");
    CasePlan plan;
    plan.predicted_seconds = 1;
    return plan;
  };
  std::set<std::string> met;
  for (int number = 1; number <= 2; ++number) {
    RunOptions options{scratch / std::to_string(number), 1};
    options.part = {number, 2};
    REQUIRE(run(fake_study(4), options) == 0);
    for (const CaseRecord& record : read_store(options.out).cases) met.insert(record.id);
  }
  CHECK(met.size() == 4);
}
