// Plugins of other people: built against the installed package alone, found by their folder, run or refused by name.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <ricochet/contract/abi.hpp>

#include "tests/plugins/installed.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

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
      nlohmann::ordered_json::parse(read_text(fs::path(RICOCHET_SOURCE_DIR) / "plugins/examples/time/study.json"));
  study["methods"]["time"] = time;
  return study.dump(1);
}

}  // namespace

TEST_CASE("plugins built outside of the tree against the installed package") {
  const Installed& installed = Installed::once();
  const ScratchFolder here;

  SECTION("one runs beside ours and agrees with the scheme that it is a case of") {
    fs::copy(installed.example("time") / "study.json", here / "study.json");
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
      REQUIRE(cases.size() == 12);
      std::map<std::string, double> end;
      for (const auto& one : cases) {
        if (one.at("contact") != "signorini" || one.at("time") == "newmark") continue;
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
