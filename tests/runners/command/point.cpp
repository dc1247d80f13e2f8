// `ricochet point`: an orbit of a stored diagram, asked for from a shell.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/runners/scratch_folder.hpp"

using Catch::Matchers::Contains;

namespace {

struct Said {
  int code = -1;
  std::string out, err;
};

/// Runs the command in a folder; `words` is a piece of shell.
Said say(const ScratchFolder& here, const std::string& words) {
  const std::string line = "cd '" + here.path().string() +
                           "' && RICOCHET_PLUGIN_PATH='" RICOCHET_PLUGIN_DIR "' '" RICOCHET_COMMAND "' " + words +
                           " >.out 2>.err </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(here / ".out"), read_text(here / ".err")};
}

std::string field(const std::string& line, int number) {
  std::istringstream fields(line);
  std::string one;
  for (int i = 0; i <= number; ++i) std::getline(fields, one, ',');
  return one;
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
  const Said run = say(here, "run diagram.json --out there --jobs 1");
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
  // case, axes …, parameter, start, index, tip_displacement, tip_velocity: by the names of the first line.
  std::ifstream points(here / "there" / "points.csv");
  std::string line, stored, id;
  std::getline(points, line);
  int parameter = 0, start = 0;
  for (int i = 0; i < 40; ++i) {
    if (field(line, i) == "parameter" && parameter == 0) parameter = i;
    if (field(line, i) == "start" && start == 0) start = i;
  }
  while (std::getline(points, line))
    if (id = field(line, 0); field(line, parameter) == "0.2" && field(line, start) == "down")
      stored += field(line, start + 2) + "," + field(line, start + 3) + "\n";
  REQUIRE_FALSE(stored.empty());

  const Said point =
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
  };
  for (const auto& [words, part] : wrong) {
    INFO(words);
    const Said refused = say(here, "point " + words);
    CHECK(refused.code == 2);
    CHECK(refused.out.empty());
    CHECK_THAT(refused.err, Contains(part));
  }
  CHECK(say(here, "point nowhere " + id + " --parameter 0.2 --start down").code == 5);
}
