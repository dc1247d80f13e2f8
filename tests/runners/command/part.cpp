/// Parts of a study, as the commands have them.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "runners/store/store.hpp"
#include "runners/study/case_id.hpp"
#include "tests/runners/command/said.hpp"

using namespace ricochet;
using Catch::Contains;

namespace {

/// Six cases whose costs differ, one of them refused and one excluded.
std::string dealt_study() {
  return R"({
    "name": "dealt", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}, "damping": {"stiffness": 1e-4}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": [3, 5]},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": [4e-4, 1e-4, 2e-4], "duration": 0.1, "march": "every-step",
    "exclude": [{"elements": 5, "step": 1e-4, "why": "not wanted"}]
  })";
}

std::set<std::string> ids_in(const std::filesystem::path& folder) {
  std::set<std::string> ids;
  for (const CaseRecord& record : read_store(folder).cases) ids.insert(record.id);
  return ids;
}

/// The first words of the lines of `plan --cases` that are ids.
std::set<std::string> planned_ids(const std::string& text) {
  std::set<std::string> ids;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (const std::string word = line.substr(0, line.find(' '));
        word.size() == 11 && word.front() == 'c' && is_former_id(word.substr(1)))
      ids.insert(word);
  return ids;
}

}  // namespace

TEST_CASE("part: one process, workers and a plan deal alike") {
  const ScratchFolder here;
  write_text(here / "study.json", dealt_study());
  std::set<std::string> all;
  for (const std::string number : {"1", "2", "3"}) {
    const std::string part = " --part " + number + "/3";
    const CommandOutput alone = say(here, "run study.json --inline" + part);
    INFO(alone.err);
    REQUIRE(alone.code == 0);
    const auto ids = ids_in(here / ("results/dealt-part-" + number + "-of-3"));
    CHECK(ids.size() == 2);
    REQUIRE(say(here, "run study.json --isolate --out workers/" + number + part).code == 0);
    CHECK(ids_in(here / ("workers/" + number)) == ids);
    const CommandOutput plan = say(here, "plan study.json --cases" + part);
    CHECK(plan.code == 0);
    CHECK_THAT(plan.out, Contains("part " + number + " of 3: kind trajectory, 2 cases"));
    CHECK(planned_ids(plan.out) == ids);
    all.insert(ids.begin(), ids.end());
  }
  CHECK(all.size() == 6);
  const CommandOutput status = say(here, "status results/dealt-part-2-of-3");
  CHECK_THAT(status.out, Contains("(dealt, trajectory, part 2 of 3): 2 of 2 cases finished"));
}

TEST_CASE("part: what is no part is a sentence, exit code 2 and no folder") {
  const ScratchFolder here;
  write_text(here / "study.json", dealt_study());
  for (const std::string command : {"run", "plan"}) {
    for (const std::string part : {"0/4", "5/4", "a/b", "4", "''"}) {
      const CommandOutput said = say(here, command + " study.json --part " + part);
      CHECK(said.code == 2);
      CHECK_THAT(said.err, Contains("expected K/N, part K of N with 1 ≤ K ≤ N, such as 3/64"));
    }
    const CommandOutput many = say(here, command + " study.json --part 1/6");
    CHECK(many.code == 2);
    CHECK_THAT(many.err, Contains("dealt: this study has 5 cases to run: at most 5 parts, not 6"));
  }
  CHECK_FALSE(std::filesystem::exists(here / "results"));
}

TEST_CASE("part: a folder goes on as the part that it holds, else exit code 2") {
  const ScratchFolder here;
  write_text(here / "study.json", dealt_study());
  REQUIRE(say(here, "run study.json --part 2/3 --out out").code == 0);
  for (const std::string part : {"--part 1/3", "--part 2/4", ""}) {
    const CommandOutput said = say(here, "run study.json --out out " + part);
    CHECK(said.code == 2);
    CHECK_THAT(said.err, Contains("out: this folder holds part 2 of 3 of \"dealt\""));
  }
  const CommandOutput again = say(here, "run study.json --part 2/3 --out out");
  CHECK(again.code == 0);
  CHECK_THAT(again.err, Contains("2 finished before, 0 to run"));
}
