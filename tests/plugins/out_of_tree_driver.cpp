// Plugins of other people: built against the installed package alone, found by their folder, run or refused by name.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <ricochet/contract/abi.hpp>
#include <sstream>

#include "tests/runners/scratch_folder.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
namespace fs = std::filesystem;

namespace {

struct Outcome {
  int code = -1;
  std::string out, err;
};

Outcome shell(const fs::path& folder, const std::string& line) {
  const std::string out = (folder / ".out").string(), err = (folder / ".err").string();
  const std::string all = "cd '" + folder.string() + "' && " + line + " >'" + out + "' 2>'" + err + "' </dev/null";
  const int status = std::system(all.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

/// Ricochet installed into a folder, and the project of plugins built against what lies there.
class Installed {
 public:
  static const Installed& once() {
    static const Installed all;
    return all;
  }
  fs::path prefix() const { return here_ / "prefix"; }
  fs::path plugins() const { return here_ / "build" / "plugins"; }
  fs::path plugin(const std::string& name) const { return plugins() / ("time-" + name + ".so"); }
  const ScratchFolder& folder() const { return here_; }

  /// Runs the installed command in a folder.
  Outcome run(const fs::path& folder, const std::string& words, const std::string& plugin_path = "") const {
    return shell(folder,
                 "RICOCHET_PLUGIN_PATH='" + plugin_path + "' '" + (prefix() / "bin/ricochet").string() + "' " + words);
  }

 private:
  Installed() {
    const std::string project = std::string(RICOCHET_SOURCE_DIR) + "/tests/plugins/out_of_tree";
    // Away from the tree, so that nothing is found there by accident.
    fs::copy(project, here_ / "project");
    step("'" RICOCHET_CMAKE "' --install '" RICOCHET_BINARY_DIR "' --prefix prefix");
    step("'" RICOCHET_CMAKE "' -S project -B build -G '" RICOCHET_GENERATOR
         "' -DCMAKE_BUILD_TYPE=Release"
         " -DCMAKE_CXX_COMPILER='" RICOCHET_CXX_COMPILER "' -DCMAKE_CXX_FLAGS='" RICOCHET_CXX_FLAGS
         "'"
         " -DCMAKE_PREFIX_PATH='" +
         prefix().string() + "' -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF");
    step("'" RICOCHET_CMAKE "' --build build");
  }
  void step(const std::string& line) const {
    const Outcome outcome = shell(here_.path(), line);
    INFO(line << "\n" << outcome.out << outcome.err);
    REQUIRE(outcome.code == 0);
  }
  ScratchFolder here_;
};

/// What is wrong with each plugin of the project, as the user is told.
const std::map<std::string, std::string> broken = {
    {"other-abi", "built for another ABI: contract: expected " + std::to_string(RICOCHET_ABI_CONTRACT) + ", found 99"},
    {"no-plugin", "a shared library, but no Ricochet plugin"},
    {"text", "not a shared library"},
    {"throws", "failed while registering: the licence of this scheme has run out"},
    {"throws-int", "failed while registering, with an exception that says nothing"},
    {"other-name",
     "says that it provides time 'other-name' but does not register it; it registers time 'yet-another-name'"},
    {"in-silence", "registers time 'unsaid' without saying so"},
    {"halfway", "failed while registering: the second scheme was not to be had"},
};

std::string study_with(const nlohmann::ordered_json& time) {
  nlohmann::ordered_json study =
      nlohmann::ordered_json::parse(read_text(fs::path(RICOCHET_SOURCE_DIR) / "tests/plugins/out_of_tree/study.json"));
  study["methods"]["time"] = time;
  return study.dump(1);
}

std::vector<std::map<std::string, std::string>> read_cases(const fs::path& file) {
  std::istringstream text(read_text(file));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> result;
    std::string cell;
    bool quoted = false;
    for (const char c : line) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        result.push_back(std::exchange(cell, ""));
      else if (c != '\r')
        cell += c;
    }
    result.push_back(cell);
    return result;
  };
  std::string line;
  std::getline(text, line);
  const auto columns = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(text, line)) {
    const auto values = cells(line);
    REQUIRE(values.size() == columns.size());
    for (std::size_t i = (rows.emplace_back(), 0); i < columns.size(); ++i) rows.back()[columns[i]] = values[i];
  }
  return rows;
}

}  // namespace

TEST_CASE("plugins built outside of the tree against the installed package") {
  const Installed& installed = Installed::once();
  const ScratchFolder here;

  SECTION("one runs beside ours and agrees with the scheme that it is a case of") {
    fs::copy(installed.folder() / "project/study.json", here / "study.json");
    fs::create_directory(here / "plugins");
    fs::copy(installed.plugin("central-difference"), here / "plugins");
    const std::string path = (here / "plugins").string();
    const std::string option = " --plugin '" + installed.plugin("central-difference").string() + "'";

    const Outcome described = installed.run(here.path(), "describe central-difference", path);
    INFO(described.out << described.err);
    CHECK(described.code == 0);
    CHECK_THAT(described.out, Contains("order 2") && Contains("must be regular") && Contains("h·ω ≤ 2"));

    for (const Outcome& run : {installed.run(here.path(), "run study.json --out by-path", path),
                               installed.run(here.path(), "run study.json --out by-file" + option)}) {
      INFO(run.out << run.err);
      CHECK(run.code == 0);
    }
    for (const char* results : {"by-path", "by-file"}) {
      const auto cases = read_cases(here / results / "cases.csv");
      REQUIRE(cases.size() == 4);
      std::map<std::string, double> end;
      for (const auto& one : cases) {
        if (one.at("mass") == "singular") {
          CHECK(one.at("status") == "refused");
          continue;
        }
        REQUIRE(one.at("status") == "done");
        CHECK(std::stod(one.at("impacts")) > 0);
        end[one.at("time")] = std::stod(one.at("tip_displacement_end"));
      }
      REQUIRE(end.size() == 2);
      // The same equation: only the rounding of coefficients may differ, over 1000 steps of a motion below 0.2 m.
      constexpr double round_off = 1e-11;
      CHECK(std::abs(end.at("central-difference") - end.at("newmark-dumont-paoli")) <= round_off);
      CHECK(std::abs(end.at("central-difference")) > 1e-3);
    }
  }

  SECTION("a name that nobody provides is a fault of the study, and the nearest one is told") {
    write_text(here / "study.json", study_with("central-diference"));
    const Outcome run = installed.run(here.path(), "run study.json", installed.plugins().string());
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains("did you mean \"central-difference\"?"));
  }

  SECTION("one that cannot serve ends a study that names it with 4, and is the only one blamed") {
    for (const auto& [name, reason] : broken) {
      const std::string file = installed.plugin(name).string();
      write_text(here / "study.json", study_with(name));
      for (const Outcome& run : {installed.run(here.path(), "run study.json", installed.plugins().string()),
                                 installed.run(here.path(), "run study.json --plugin '" + file + "'")}) {
        INFO(name << ": " << run.out << run.err);
        CHECK(run.code == 4);
        CHECK_THAT(run.err, StartsWith("ricochet: plugin error: ") && Contains(file + ": ") && Contains(reason));
        for (const auto& [other, ignored] : broken)
          if (other != name) CHECK_THAT(run.err, !Contains(installed.plugin(other).string()));
        CHECK_FALSE(fs::exists(here / "results"));
      }
    }
  }

  SECTION("the doctor lists each with its state and reason, and goes on") {
    const Outcome doctor = installed.run(here.path(), "doctor", installed.plugins().string());
    INFO(doctor.out << doctor.err);
    CHECK(doctor.code == 4);
    const auto line_of = [&](const std::string& name) {
      const std::size_t at = doctor.out.find("time-" + name + ".so ");
      return at == std::string::npos ? "" : doctor.out.substr(at, doctor.out.find('\n', at) - at);
    };
    CHECK_THAT(line_of("central-difference"), Contains(" ok "));
    for (const auto& [name, reason] : broken) CHECK_THAT(line_of(name), Contains(" unusable ") && Contains(reason));
    CHECK_THAT(doctor.out, Contains(std::to_string(broken.size()) + " plugin file(s) cannot serve"));
  }

  SECTION("broken neighbours do not hinder a study that names none of them") {
    write_text(here / "study.json", study_with("central-difference"));
    const Outcome run = installed.run(here.path(), "run study.json --out results", installed.plugins().string());
    INFO(run.out << run.err);
    CHECK(run.code == 0);
    CHECK(installed.run(here.path(), "schema", installed.plugins().string()).code == 0);
    CHECK(installed.run(here.path(), "list time", installed.plugins().string()).code == 4);
  }

  SECTION("a stripped one still serves") {
    const std::string file = installed.plugin("central-difference").string();
    const Outcome strip = shell(here.path(), "strip -o time-central-difference.so '" + file + "'");
    INFO(strip.err);
    REQUIRE(strip.code == 0);  // part of binutils, which every compiler needs
    const Outcome described = installed.run(here.path(), "describe central-difference", here.path().string());
    INFO(described.out << described.err);
    CHECK(described.code == 0);
  }
}

namespace {

/// Nine cases (of a mass: three), one of which uses the plugin `crashes` of a role, with these parameters.
std::string nine_cases(const std::string& role, nlohmann::ordered_json crashes, double budget) {
  auto study = nlohmann::ordered_json::parse(study_with("newmark-dumont-paoli"));
  crashes["name"] = "crashes";
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = "signorini";
  study["duration"] = 0.02;
  if (budget > 0) study["budget"] = budget;
  auto& methods = study["methods"][role] = nlohmann::ordered_json::array({crashes});
  for (int i = 0; i < 8; ++i) {
    if (role == "contact") methods.push_back({{"name", "penalty"}, {"stiffness", 1e4 + 1e3 * i}});
    if (role == "time") methods.push_back({{"name", "newmark-dumont-paoli"}, {"beta", 0.25 + 0.02 * i}});
  }
  // Masses have no parameter to tell eight of them apart.
  if (role == "mass") methods.insert(methods.end(), {"consistent", "lumped"});
  return study.dump(1);
}

}  // namespace

TEST_CASE("plugins that end the program or never return cost a study one case, and are named") {
  const Installed& installed = Installed::once();
  const ScratchFolder here;
  struct Bad {
    std::string role, function;
    nlohmann::ordered_json parameters;
    int code = 0;        // of the first run, as a shell tells it
    std::string reason;  // in the row, at last
    double budget = 0;
  };
  const Bad bad = GENERATE(
      Bad{"contact", "solve", {{"how", "segv"}}, 139, "by signal 11 (segmentation fault) in solve()"},
      Bad{"contact", "prepare", {{"how", "abort"}, {"where", "prepare"}}, 134, "by signal 6 (abort) in prepare()"},
      Bad{"contact", "solve", {{"how", "overflow"}}, 139, "by signal 11 (segmentation fault) in solve()"},
      Bad{"time", "plan", {{"how", "exit"}}, 3, "by a call of exit() in plan()"},
      Bad{"time", "plan", {{"how", "throw"}}, 3, "plan()"},
      Bad{"time", "plan", {{"how", "loop"}}, 3, "did not return from plan() within the budget of 0.5 s", 0.5},
      Bad{"contact", "solve", {{"how", "loop"}}, 3, "did not return from solve() within the budget of 0.5 s", 0.5},
      Bad{"mass", "build", {{"how", "segv"}}, 139, "by signal 11 (segmentation fault) in build()"});
  const std::string plugin = bad.role + " 'crashes'";
  CAPTURE(plugin, bad.parameters.dump());
  write_text(here / "study.json", nine_cases(bad.role, bad.parameters, bad.budget));
  const auto run = [&] { return installed.run(here.path(), "run study.json --out out", installed.plugins().string()); };
  const Outcome first = run();
  INFO(first.out << first.err);
  CHECK(first.code == bad.code);
  const bool ended = !fs::exists(here / "out/cases.csv");
  if (ended) {
    CHECK_THAT(first.err, Contains("plugin " + plugin) && Contains(bad.function + "(): ended by"));
    const Outcome second = run();
    INFO(second.out << second.err);
    CHECK(second.code == 3);
    CHECK_THAT(second.err, Contains("is kept as failed: plugin " + plugin));
  }
  int failed = 0;
  for (const auto& one : read_cases(here / "out/cases.csv")) {
    if (one.at(bad.role) != "crashes") {
      CHECK(one.at("status") == "done");
      continue;
    }
    ++failed;
    CHECK(one.at("status") == "failed");
    CHECK_THAT(one.at("reason"), Contains("plugin " + plugin) && Contains(bad.reason));
    CHECK(fs::exists(here / "out/failures" / (one.at("id") + ".json")));
  }
  CHECK(failed == 1);
  const Outcome report = installed.run(here.path(), "report out");
  CHECK(report.code == 0);
  CHECK_THAT(read_text(here / "out/report.html"), Contains("crashes"));
}
