// kill -9 of a run at random moments, and at those in which it writes its report. The same command goes on to the
// tables of a run that nobody disturbs. RICOCHET_KILLS=50 kills so many in all.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "tests/places.hpp"
#include "tests/runners/same_tables.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/workers/quick_studies.hpp"

using quick_studies::Json;
using quick_studies::study_of;
using ricochet::tests::places;
namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

int kills() {
  const char* text = std::getenv("RICOCHET_KILLS");
  constexpr int usual = 3;
  return text ? std::atoi(text) : usual;
}

/// An oscillator between stops, followed along its forcing.
Json continuation() {
  return Json::parse(R"({
    "name": "here", "question": "Is it the same?", "kind": "continuation",
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.1,
                            "force": {"amplitude": 0.5, "pulsation": 0.8, "phase": 0}},
              "stops": {"lower": null, "upper": 1}},
    "methods": {"mass": "consistent", "contact": {"name": "penalty", "stiffness": [5, 10]}, "time": "newmark"},
    "parameter": {"pointer": "/scene/structure/force/amplitude", "from": 0.3, "to": 1.2},
    "steps_per_period": 400, "orbits": [{"at": 0.5, "from": "rest", "periods": 100}]})");
}

pid_t start(const ScratchFolder& here, const std::string& out) {
  const pid_t process = ::fork();
  if (process != 0) return process;
  const std::string line = "cd '" + here.path().string() + "' && RICOCHET_PLUGIN_PATH= exec '" + places().command +
                           "' run study.json --isolate --jobs 2 --out " + out + " >said 2>told </dev/null";
  ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
  ::_exit(127);
}

int end_of(pid_t process) {
  int status = 0;
  while (::waitpid(process, &status, 0) < 0) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// Whether a file of the folder is being written.
bool writes(const fs::path& folder) {
  std::error_code ignored;
  return std::any_of(fs::directory_iterator(folder, ignored), fs::directory_iterator(), [](const auto& one) {
    const std::string name = one.path().filename().string();
    return name.starts_with("report.html.") || name.find(".csv.") != std::string::npos;
  });
}

}  // namespace

TEST_CASE("a run that is killed at any moment goes on to the tables of one that is not") {
  const std::string kind = GENERATE("trajectory", "continuation", "basins");
  CAPTURE(kind);
  const ScratchFolder here;
  write_text(here / "study.json", (kind == "continuation" ? continuation() : study_of(kind)).dump());
  const auto begun = Clock::now();
  REQUIRE(end_of(start(here, "whole")) == 0);
  const double whole = std::chrono::duration<double>(Clock::now() - begun).count();
  constexpr int kinds = 3;
  std::mt19937 random(static_cast<unsigned>(kind.size()));
  for (int kill = 0; kill < (kills() + kinds - 1) / kinds; ++kill) {
    const std::string out = "out" + std::to_string(kill);
    const pid_t process = start(here, out);
    const double moment = std::uniform_real_distribution<double>(0, whole)(random);
    const bool at_writing = (kill % 2 == 0) == (kind == "trajectory");
    CAPTURE(kill, moment, at_writing);
    int status = 0;
    bool ended = false;
    for (const auto since = Clock::now(); !ended; ::usleep(200)) {
      if (at_writing ? writes(here / out) : Clock::now() - since > std::chrono::duration<double>(moment)) break;
      ended = ::waitpid(process, &status, WNOHANG) == process;
    }
    if (!ended) {
      ::kill(process, SIGKILL);
      const int end = end_of(process);
      CHECK((end == -SIGKILL || end == 0));  // 0: it ended between the look and the signal
    }
    const int again = end_of(start(here, out));
    INFO(read_text(here / "told"));
    CHECK(again == 0);
    same_tables::check_same(here / "whole", here / out);
    CHECK_FALSE(writes(here / out));
  }
}
