// `ricochet point`: an orbit of a stored diagram, asked for from a shell.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "runners/store/store.hpp"
#include "tests/runners/command/said.hpp"

using Catch::Matchers::Contains;

namespace {

std::string field(const std::string& line, int number) {
  std::istringstream fields(line);
  std::string one;
  for (int i = 0; i <= number; ++i) std::getline(fields, one, ',');
  return one;
}

/// Where a table's first line has this name.
int place(const std::string& line, const std::string& name) {
  for (int i = 0; i < 40; ++i)
    if (field(line, i) == name) return i;
  FAIL("no column " << name << " in " << line);
  return -1;
}

/// Words after `ricochet point` that are wrong, and a part of what is said of them.
void check_refused(const ScratchFolder& here, const std::vector<std::pair<std::string, std::string>>& wrong) {
  for (const auto& [words, part] : wrong) {
    INFO(words);
    const CommandOutput refused = say(here, "point " + words);
    CHECK(refused.code == 2);
    CHECK(refused.out.empty());
    CHECK_THAT(refused.err, Contains(part));
  }
}

}  // namespace

TEST_CASE("A point of a diagram is printed as it was stored, or the nearest names are told") {
  const ScratchFolder here;
  std::ofstream(here / "diagram.json") << R"({
    "name": "diagram", "kind": "bifurcation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.1,
                            "force": {"amplitude": 1, "pulsation": 2.6}},
              "stops": {"upper": 0.25, "at": "tip"}},
    "methods": {"mass": "consistent", "contact": "signorini", "time": "newmark-dumont-paoli"},
    "parameter": {"pointer": "/scene/stops/upper", "from": 0.1, "to": 0.3, "count": 3},
    "steps_per_period": 64, "start": ["rest", "down"], "transient": {"periods": 8, "at_most": 8}, "keep": 16
  })";
  const CommandOutput run = say(here, "run diagram.json --out there --jobs 1");
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
  // case, axes …, parameter, start, index, tip_displacement, tip_velocity: by the names of the first line.
  std::ifstream points(here / "there" / "points.csv");
  std::string line, stored, id;
  std::getline(points, line);
  const int parameter = place(line, "parameter"), start = place(line, "start");
  while (std::getline(points, line))
    if (id = field(line, 0); field(line, parameter) == "0.2" && field(line, start) == "down")
      stored += field(line, start + 2) + "," + field(line, start + 3) + "\n";
  REQUIRE_FALSE(stored.empty());

  const CommandOutput point =
      say(here, "point there " + id.substr(0, 4) + " --parameter 0.2 --start down --periods 16 --samples 1");
  INFO(point.err);
  CHECK(point.code == 0);
  std::istringstream printed(point.out);
  std::string marched;
  std::getline(printed, line);
  CHECK(line == "t,tip_displacement,tip_velocity");
  while (std::getline(printed, line)) marched += line.substr(line.find(',') + 1) + "\n";
  CHECK(marched == stored);
  CHECK_THAT(point.err, Contains("16 of 16 strobes as stored"));

  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"there " + id + " --parameter 0.25 --start down", "0.1, 0.2, 0.3"},
      {"there " + id + " --parameter 0.2 --start dwon", "did you mean \"down\"?"},
      {"there " + id + "0 --parameter 0.2 --start down", "did you mean \"" + id + "\"?"},
      {"there " + id + " --start down", "expected --parameter VALUE and --start NAME"},
      {"there " + id + " --parameter one --start down", "expected a number"},
      {"there " + id + " --parameter 0.2 --start down --samples 0", "outside [1, "},
      {"there " + id + " --cell 0.2,1", "kind bifurcation; expected --parameter VALUE"},
  };
  check_refused(here, wrong);
  CHECK(say(here, "point nowhere " + id + " --parameter 0.2 --start down").code == 5);
}

TEST_CASE("A cell of a grid is marched as its run did, or the nearest cells are told") {
  const ScratchFolder here;
  std::ofstream(here / "grid.json") << R"({
    "name": "grid", "kind": "basins",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.3,
                            "force": {"amplitude": 1, "pulsation": 2.6}},
              "stops": {"upper": 0.2, "at": "tip"}, "initial": {"displacement": 0, "velocity": 0}},
    "methods": {"mass": "consistent", "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "restitution": 0.3}},
    "axes": [{"pointer": "/scene/initial/displacement", "from": -1, "to": 0.1, "count": 12},
             {"pointer": "/scene/initial/velocity", "from": -1, "to": 1, "count": 9}],
    "steps_per_period": 64, "transient": {"periods": 60, "at_most": 160}, "keep": 32, "refine": true
  })";
  const CommandOutput run = say(here, "run grid.json --out there --jobs 1");
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
  std::ifstream cells(here / "there" / "cells.csv");
  std::string line;
  std::getline(cells, line);
  const int x = place(line, "x"), marched = place(line, "marched");
  std::string id;
  int compared = 0, filled = 0;
  while (std::getline(cells, line)) {
    id = field(line, 0);
    const bool alone = field(line, marched) == "true";
    if ((alone ? compared : filled) == 3) continue;
    const CommandOutput point = say(here, "point there " + id + " --cell=" + field(line, x) + "," + field(line, x + 1) +
                                              " --periods 2 --samples 16");
    INFO(line << "\n" << point.err);
    CHECK(point.code == 0);
    CHECK(std::count(point.out.begin(), point.out.end(), '\n') == 33);
    const std::string period = field(line, x + 3);
    CHECK_THAT(point.err, Contains(field(line, x + 2) + " " + period));
    CHECK_THAT(point.err,
               Contains(alone ? period + " of " + period + " strobes as stored" : "the run filled this cell"));
    ++(alone ? compared : filled);
  }
  CHECK(compared == 3);
  CHECK(filled == 3);
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"there " + id + " --cell=0.05,0", "/scene/initial/displacement 0.05; the nearest values are"},
      {"there " + id + " --cell 0.1", "expected two numbers X,Y"},
      {"there " + id + " --cell 0.1,zero", "expected two numbers X,Y"},
      {"there " + id, "kind basins; expected --cell X,Y"},
      {"there " + id + " --parameter 0.2 --start down", "kind basins; expected --cell X,Y"},
  };
  check_refused(here, wrong);
}

// How far a run is, and what more workers would make of it.
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
  const CommandOutput ended = say(here, "status results/far");
  CHECK(ended.code == 0);
  CHECK_THAT(ended.out, Contains("2 of 2 cases finished: 2 done") && !Contains("under way"));

  // A third case that nobody has begun.
  const auto begin = [&] {
    Store store(here / "results/far", false);
    StudyResults more = read_store(here / "results/far");
    std::vector<ExpectedCase> cases;
    for (const CaseRecord& one : more.cases) cases.push_back({one.id, "of another program"});
    more.expected_cases = 3;
    store.begin(more, cases);
    store.save_progress("1/3 cases, 33 %, 5 s left");
  };
  begin();
  const CommandOutput going = say(here, "status results/far");
  CHECK(going.code == 0);
  CHECK_THAT(going.out, Contains("0 of 3 cases finished") && Contains("33 %"));
  CHECK(going.out.find("has ended") == std::string::npos);
  CHECK_THAT(going.out, !Contains("not there any more"));
  // By a process that has ended.
  if (const pid_t child = ::fork(); child == 0) {
    begin();
    ::_exit(0);
  } else {
    ::waitpid(child, nullptr, 0);
  }
  CHECK_THAT(say(here, "status results/far").out, Contains("that process is not there any more"));

  const CommandOutput both = say(here, "status results/far results/none");
  CHECK(both.code == 5);
  CHECK_THAT(both.err, Contains("none"));
  CHECK(say(here, "status").code == 2);
}

TEST_CASE("plan --workers: what one worker takes is the whole, what many take is no less than the longest chain") {
  const ScratchFolder here;
  write_text(here / "study.json", free_beam().dump());
  const CommandOutput one = say(here, "plan study.json --workers 1");
  CHECK(one.code == 0);
  CHECK_THAT(one.out, Contains("with 1 worker: "));
  const CommandOutput many = say(here, "plan study.json --workers 500");
  CHECK_THAT(many.out, Contains("with 500 workers: ") && Contains("shorten nothing") && Contains("memory"));
  for (const std::string wrong : {"0", "-3", "many"}) {
    const CommandOutput said = say(here, "plan study.json --workers " + wrong);
    CHECK(said.code == 2);
    CHECK_THAT(said.err, Contains("--workers"));
  }
}

TEST_CASE("slurm: bad times, no program of ranks and studies that are none are told") {
  const ScratchFolder here;
  write_text(here / "study.json", free_beam().dump());
  CHECK_THAT(say(here, "slurm study.json").err, Contains("--time"));
  for (const std::string wrong : {"soon", "1:2:3:4", "0:30", "0"}) {
    const CommandOutput said = say(here, "slurm study.json --time " + wrong);
    INFO(said.err);
    CHECK(said.code == 2);
    CHECK(said.out.empty());
  }
  CHECK(say(here, "slurm none.json --time 10").code == 2);
  CHECK(say(here, "slurm study.json --time 10 --nodes 0").code == 2);
}

TEST_CASE("An orbit of a branch is solved again, or what the branch has is told") {
  const ScratchFolder here;
  std::ofstream(here / "branch.json") << R"({
    "name": "branch", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.04,
                            "force": {"amplitude": 0.5, "pulsation": 1.3}},
              "stops": {"upper": 1, "at": "tip"}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": 30},
                "time": {"name": "newmark-dumont-paoli", "beta": 0.25}},
    "steps_per_period": 200, "parameter": {"pointer": "/scene/structure/force/amplitude", "from": 0.3, "to": 1.0},
    "orbits": [{"at": 0.5, "from": "free"}], "both_ways": false, "switch": null, "at_most": {"arc": 10}
  })";
  const CommandOutput run = say(here, "run branch.json --out there --jobs 1");
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
  std::ifstream branches(here / "there" / "branches.csv");
  std::string line, last, id;
  std::getline(branches, line);
  const int arc = place(line, "arc"), tip = place(line, "tip_displacement");
  while (std::getline(branches, line)) last = line;
  id = field(last, 0);
  const CommandOutput point =
      say(here, "point there " + id.substr(0, 4) + " --branch orbit-1+ --arc " + field(last, arc) + " --snapshots 20");
  INFO(point.out << point.err);
  REQUIRE(point.code == 0);
  CHECK_THAT(point.out, Contains("contact runs:") && Contains("residual") && Contains("21 instants"));
  std::ifstream period(here / "there" / "points" / (id + "_orbit-1+_" + field(last, arc) + ".csv"));
  REQUIRE(period);
  std::getline(period, line);
  std::getline(period, line);
  CHECK(std::stod(field(line, 1)) == Approx(std::stod(field(last, tip))).margin(1e-12));
  // The next report shows the film, and says of which orbit it is.
  REQUIRE(say(here, "report there").code == 0);
  CHECK_THAT(read_text(here / "there" / "report.html"), Contains("orbit-1+ at an arc of " + field(last, arc) + " m"));
  const CommandOutput elsewhere = say(here, "point there " + id + " --branch orbit-1+ --arc 0.1 --out one.csv");
  CHECK(elsewhere.code == 0);
  CHECK_FALSE(read_text(here / "one.csv").empty());

  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"there " + id + " --branch orbit-1 --arc 0.1", "did you mean \"orbit-1+\"?"},
      {"there " + id + " --branch orbit-1+ --arc 99", "the branch orbit-1+ goes from 0 to "},
      {"there " + id + " --branch orbit-1+ --arc=-1", "the branch orbit-1+ goes from 0 to "},
      {"there " + id + " --branch orbit-1+ --arc one", "expected a number"},
      {"there " + id + " --branch orbit-1+", "expected --branch NAME and --arc S"},
      {"there " + id + "0 --branch orbit-1+ --arc 0", "did you mean \"" + id + "\"?"},
      {"there " + id + " --parameter 0.5 --start rest", "kind continuation; expected --branch NAME"},
      {"there " + id + " --branch orbit-1+ --arc 0 --periods 3", "kind continuation; expected --branch NAME"},
  };
  check_refused(here, wrong);
}
