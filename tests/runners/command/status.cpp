/// How far a run is, and what more workers would make of it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "runners/store/store.hpp"
#include "tests/runners/command/said.hpp"

using namespace ricochet;
using Catch::Contains;

namespace {

nlohmann::ordered_json free_beam() {
  return nlohmann::ordered_json::parse(R"({
    "name": "far", "kind": "trajectory",
    "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                            "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}},
              "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
              "initial": {"displacement": "0.04*x^2", "velocity": "-2*x"}},
    "mesh": {"elements": 3},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "step": [2e-4, 1e-4], "duration": 0.02
  })");
}

}  // namespace

TEST_CASE("status: a folder says how many of its cases are finished, as what, and whether somebody is at work") {
  const ScratchFolder here;
  nlohmann::ordered_json study = free_beam();
  write_text(here / "study.json", study.dump());
  REQUIRE(say(here, "run study.json").code == 0);
  const Said ended = say(here, "status results/far");
  CHECK(ended.code == 0);
  CHECK_THAT(ended.out, Contains("2 of 2 cases finished: 2 done") && !Contains("under way"));

  // A third case that nobody has begun.
  {
    Store store(here / "results/far", false);
    StudyResults more = read_store(here / "results/far");
    std::vector<ExpectedCase> cases;
    for (const CaseRecord& one : more.cases) cases.push_back({one.id, "of another program"});
    more.expected_cases = 3;
    store.begin(more, cases);
    store.save_progress("1/3 cases, 33 %, 5 s left");
  }
  const Said going = say(here, "status results/far");
  CHECK(going.code == 0);
  CHECK_THAT(going.out, Contains("0 of 3 cases finished") && Contains("33 %"));
  CHECK(going.out.find("has ended") == std::string::npos);

  const Said both = say(here, "status results/far results/none");
  CHECK(both.code == 5);
  CHECK_THAT(both.err, Contains("none"));
  CHECK(say(here, "status").code == 2);
}

TEST_CASE("plan --workers: what one worker takes is the whole, what many take is no less than the longest chain") {
  const ScratchFolder here;
  write_text(here / "study.json", free_beam().dump());
  const Said one = say(here, "plan study.json --workers 1");
  CHECK(one.code == 0);
  CHECK_THAT(one.out, Contains("with 1 worker: "));
  const Said many = say(here, "plan study.json --workers 500");
  CHECK_THAT(many.out, Contains("with 500 workers: ") && Contains("shorten nothing") && Contains("memory"));
  for (const std::string wrong : {"0", "-3", "many"}) {
    const Said said = say(here, "plan study.json --workers " + wrong);
    CHECK(said.code == 2);
    CHECK_THAT(said.err, Contains("--workers"));
  }
}

TEST_CASE("slurm: bad times, no program of ranks and studies that are none are told") {
  const ScratchFolder here;
  write_text(here / "study.json", free_beam().dump());
  CHECK_THAT(say(here, "slurm study.json").err, Contains("--time"));
  for (const std::string wrong : {"soon", "1:2:3:4", "0:30", "0"}) {
    const Said said = say(here, "slurm study.json --time " + wrong);
    INFO(said.err);
    CHECK(said.code == 2);
    CHECK(said.out.empty());
  }
  CHECK(say(here, "slurm none.json --time 10").code == 2);
  CHECK(say(here, "slurm study.json --time 10 --nodes 0").code == 2);
}
