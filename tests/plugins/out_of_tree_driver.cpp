// Plugins of other people: built against the installed package alone, found by their folder, run or refused by name.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <ricochet/contract/abi.hpp>
#include <ricochet/contract/step_plan.hpp>

#include "tests/places.hpp"
#include "tests/plugins/installed.hpp"

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;
using ricochet::tests::places;

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
    {"aborts-at-load", "ended by signal 6 (aborted) while it was loaded"},
    {"exits-at-load", "ended the process with exit code 7 while it was loaded"},
    {"debug-library", "built for another ABI: layout: std::vector<double>: expected 24 bytes, found "},
    {"one-more-field", "built for another ABI: layout: Stage: expected " + std::to_string(sizeof(ricochet::Stage)) +
                           " bytes, found " + std::to_string(sizeof(ricochet::Stage) + sizeof(double)) +
                           "; rebuild it against this version of Ricochet"},
    {"undefined", "cannot be loaded: undefined symbol: nowhere(double)"},
    {"parameter-name", "declares the parameter 'name', a key that every method has already; choose another"},
};

using Json = nlohmann::ordered_json;

std::string study_with(const Json& time, const Json& mass = {"consistent", "singular"}) {
  Json study = Json::parse(read_text(fs::path(places().source) / "plugins/examples/time/study.json"));
  study["methods"]["time"] = time;
  study["methods"]["mass"] = mass;
  study["methods"]["contact"] = "signorini";
  return study.dump(1);
}

/// What the misbehaving plugins do when asked, by the value of their parameter, and what is said of it after
/// "plugin ROLE 'misbehaves' (FILE), ".
const std::map<std::string, std::string> wrong_schemes = {
    {"no-object", "make(): its factory returned no object"},
    {"throw-in-constructor", "make(): no licence"},
    {"throw", "plan(): my plan failed"},
    {"throw-int", "plan(): an exception that says nothing"},
    {"empty-refusal", "plan(): refuses without a sentence"},
    {"ill-formed", "plan(): ill-formed plan: stage 1: update must give one combination per slot"},
    {"not-a-number", "plan(): ill-formed plan: velocity is not finite"},
};
const std::map<std::string, std::string> wrong_masses = {
    {"throw-int", "build(): an exception that says nothing"},
    {"empty-refusal", "build(): refuses without a sentence"},
    {"empty", "build(): its mass is 0 × 0; expected 8 × 8, the dofs of the space"},
    {"small", "build(): its mass is 2 × 2; expected 8 × 8, the dofs of the space"},
    {"not-a-number", "build(): the mass holds nan at (0, 0)"},
    {"negative", "build(): the mass has -"},
    {"indefinite", "build(): the mass has a negative eigenvalue"},
    {"unsymmetric", "build(): the mass is not symmetric"},
    {"kernel", "build(): declares a kernel of dimension 3, its mass has 0"},
    {"hidden-kernel", "build(): declares a kernel of dimension 0, its mass has 8"},
};
/// Those that end the process which asks: only where a child process asks.
const std::map<std::string, std::string> ending_schemes = {
    {"crash", "plan(): ended by signal 11 (segmentation fault)"},
    {"exit", "plan(): ended the process with exit code 7"},
};

Json all_of(const std::map<std::string, std::string>& wrong) {
  Json how = Json::array();
  for (const auto& [way, ignored] : wrong) how.push_back(way);
  return {{"name", "misbehaves"}, {"how", how}};
}

/// Nine cases (of a mass: three), one of which uses the plugin `crashes` of a role, with these parameters.
std::string nine_cases(const std::string& role, nlohmann::ordered_json crashes, double budget) {
  auto study = nlohmann::ordered_json::parse(study_with("newmark-dumont-paoli"));
  crashes["name"] = "crashes";
  study["methods"]["mass"] = "consistent";
  study["methods"]["contact"] = "signorini";
  study["duration"] = 0.1;
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

/// Of plugins that end their process or never return: one of each kind.
void check_that_one_case_is_lost(const Installed& installed, const ScratchFolder& here) {
  struct Bad {
    std::string role, function;
    nlohmann::ordered_json parameters;
    std::string reason;  // in the row, at last
    double budget = 0;
  };
  const Bad bad = GENERATE(
      Bad{"contact", "solve", {{"how", "segv"}}, "signal 11 (segmentation fault)"},
      Bad{"contact", "prepare", {{"how", "abort"}, {"where", "prepare"}}, "signal 6 (aborted)"},
      Bad{"contact", "solve", {{"how", "overflow"}}, "signal 11 (segmentation fault)"},
      Bad{"time", "plan", {{"how", "exit"}}, "a call of exit()"}, Bad{"time", "plan", {{"how", "throw"}}, "plan()"},
      Bad{"time", "plan", {{"how", "loop"}}, "did not return from plan() within the budget of 0.5 s", 0.5},
      Bad{"contact", "solve", {{"how", "loop"}}, "did not return from solve() within the budget of 0.5 s", 0.5},
      Bad{"mass", "build", {{"how", "segv"}}, "signal 11 (segmentation fault)"});
  const bool crashes = bad.reason.find("signal") != std::string::npos || bad.reason.find("exit") != std::string::npos;
  const std::string plugin = bad.role + " 'crashes'";
  CAPTURE(plugin, bad.parameters.dump());
  write_text(here / "study.json", nine_cases(bad.role, bad.parameters, bad.budget));
  // What old scripts ask for changes nothing.
  const std::string words = GENERATE("", " --threads");
  const Outcome first = installed.run(here.path(), "run study.json --out out" + words, installed.plugins().string());
  INFO(first.out << first.err);
  CHECK(first.code == 3);
  int failed = 0;
  for (const auto& one : read_cases(here / "out/cases.csv")) {
    if (one.at(bad.role) != "crashes") {
      CHECK(one.at("status") == "done");
      continue;
    }
    ++failed;
    CHECK(one.at("status") == "failed");
    const std::string reason = crashes ? bad.function + "(): its process was ended twice by " + bad.reason : bad.reason;
    CHECK_THAT(one.at("reason"), Contains("plugin " + plugin) && Contains(reason));
    CHECK(fs::exists(here / "out/failures" / (one.at("case") + ".json")));
  }
  CHECK(failed == 1);
  const Outcome report = installed.run(here.path(), "report out");
  CHECK(report.code == 3);
  CHECK_THAT(read_text(here / "out/report.html"), Contains("crashes"));
}

}  // namespace

TEST_CASE("plugins built outside of the tree against the installed package") {
  const Installed& installed = Installed::once();
  const ScratchFolder here;

  SECTION("one runs beside ours and agrees with the scheme that it is a case of") {
    fs::copy(installed.example("time") / "study.json", here / "study.json");
    fs::create_directory(here / "plugins");
    fs::copy(installed.plugin("leap-frog"), here / "plugins");
    const std::string path = (here / "plugins").string();
    const std::string option = " --plugin '" + installed.plugin("leap-frog").string() + "'";

    const Outcome described = installed.run(here.path(), "describe leap-frog", path);
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
      CHECK(std::abs(end.at("leap-frog") - end.at("newmark-dumont-paoli")) <= round_off);
      CHECK(std::abs(end.at("leap-frog")) > 1e-3);
    }
  }

  SECTION("a name that nobody provides is a fault of the study, and the nearest one is told") {
    write_text(here / "study.json", study_with("leap-forg"));
    const Outcome run = installed.run(here.path(), "run study.json", installed.plugins().string());
    CHECK(run.code == 2);
    CHECK_THAT(run.err, Contains("did you mean \"leap-frog\"?"));
  }

  SECTION("one that cannot serve ends a study that names it with 4, and is the only one blamed") {
    for (const auto& [name, reason] : broken) {
      const std::string file = installed.plugin(name).string();
      write_text(here / "study.json", study_with(name));
      for (const Outcome& run : {installed.run(here.path(), "run study.json", installed.plugins().string()),
                                 installed.run(here.path(), "run study.json --plugin '" + file + "'")}) {
        INFO(name << ": " << run.out << run.err);
        CHECK(run.code == 4);
        CHECK_THAT(run.err, StartsWith("ricochet: ") && Contains(file + ": ") && Contains(reason));
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
    CHECK_THAT(line_of("leap-frog"), Contains(" ok "));
    for (const auto& [name, reason] : broken) CHECK_THAT(line_of(name), Contains(" unusable ") && Contains(reason));
    CHECK_THAT(doctor.out, Contains(std::to_string(broken.size()) + " plugin file(s) cannot serve"));
  }

  SECTION("broken neighbours do not hinder a study that names none of them") {
    write_text(here / "study.json", study_with("leap-frog"));
    const Outcome run = installed.run(here.path(), "run study.json --out results", installed.plugins().string());
    INFO(run.out << run.err);
    CHECK(run.code == 0);
    CHECK(installed.run(here.path(), "schema", installed.plugins().string()).code == 0);
    CHECK(installed.run(here.path(), "list time", installed.plugins().string()).code == 4);
  }

  SECTION("a plugin that goes wrong fails its own cases, by name, and no other") {
    const std::string scheme = "plugin time 'misbehaves' (" + installed.plugin("misbehaves").string() + "), ";
    const std::string mass =
        "plugin mass 'misbehaves' (" + (installed.plugins() / "mass-misbehaves.so").string() + "), ";
    struct Role {
      std::string study, column, prefix;
      const std::map<std::string, std::string>* wrong;
    };
    for (const Role& role :
         {Role{study_with({"newmark", all_of(wrong_schemes)}, "consistent"), "time", scheme, &wrong_schemes},
          Role{study_with("newmark", {"consistent", all_of(wrong_masses)}), "mass", mass, &wrong_masses}}) {
      write_text(here / "study.json", role.study);
      const Outcome run =
          installed.run(here.path(), "run study.json --out " + role.column, installed.plugins().string());
      INFO(run.out << run.err);
      CHECK(run.code == 3);
      const auto cases = read_cases(here / role.column / "cases.csv");
      CHECK(cases.size() == role.wrong->size() + 1);
      for (const auto& one : cases) {
        if (one.at(role.column) != "misbehaves") {
          CHECK(one.at("status") == "done");
          continue;
        }
        const std::string way = one.at(role.column + ".how");
        INFO(way);
        CHECK(one.at("status") == "failed");
        CHECK_THAT(one.at("reason"), StartsWith(role.prefix + role.wrong->at(way)));
      }
      const Outcome plan = installed.run(here.path(), "plan study.json", installed.plugins().string());
      INFO(plan.out << plan.err);
      CHECK(plan.code == 3);
      for (const auto& [way, sentence] : *role.wrong)
        CHECK_THAT(plan.out, Contains("fails: " + role.prefix + sentence));
      CHECK_THAT(plan.out,
                 Contains("1 to run, 0 refused, 0 excluded, " + std::to_string(role.wrong->size()) + " failed"));
    }
    const Outcome described = installed.run(here.path(), "describe misbehaves", installed.plugins().string());
    INFO(described.out << described.err);
    CHECK(described.code == 3);
    CHECK_THAT(described.out, Contains("fails: " + scheme + wrong_schemes.at("ill-formed")) &&
                                  Contains("fails: " + mass + wrong_masses.at("negative")));
  }

  SECTION("the plan of a study outlives a plugin that ends the process that asks it") {
    write_text(here / "study.json", study_with({"newmark", all_of(ending_schemes)}, "consistent"));
    const Outcome plan = installed.run(here.path(), "plan study.json", installed.plugins().string());
    INFO(plan.out << plan.err);
    CHECK(plan.code == 3);
    for (const auto& [way, sentence] : ending_schemes)
      CHECK_THAT(plan.out, Contains("fails: plugin time 'misbehaves' (" + installed.plugin("misbehaves").string() +
                                    "), " + sentence));
    CHECK_THAT(plan.out, Contains("1 to run, 0 refused, 0 excluded, 2 failed"));
  }

  SECTION("a library that never comes back from loading is given up") {
    const Outcome doctor = installed.run(here.path(), "doctor", (installed.folder() / "build" / "slow").string());
    INFO(doctor.out << doctor.err);
    CHECK(doctor.code == 4);
    CHECK_THAT(doctor.out, Contains("did not end within 10 s while it was loaded"));
  }

  SECTION("who is shadowed, and which folders are none, is said where a study uses it") {
    const std::string hidden = (installed.folder() / "build" / "shadowed").string();
    const std::string sentence = "time 'newmark' of " + hidden + "/time-newmark.so is shadowed by ";
    const std::string path = hidden + ":" + (here / "nowhere").string();
    write_text(here / "study.json", study_with("newmark", "consistent"));
    const Outcome run = installed.run(here.path(), "run study.json --out results", path);
    const Outcome plan = installed.run(here.path(), "plan study.json", path);
    INFO(run.err << plan.out << plan.err);
    CHECK(run.code == 0);
    CHECK(plan.code == 0);
    for (const std::string& text : {run.err, plan.out}) {
      CHECK_THAT(text, Contains(sentence + installed.prefix().string()));
      CHECK_THAT(text, Contains("no such plugin folder: " + (here / "nowhere").string()));
    }
    write_text(here / "study.json", study_with("moreau-jean", "consistent"));
    CHECK_THAT(installed.run(here.path(), "plan study.json", path).out, !Contains("shadowed"));
  }

  SECTION("a compiler that is told too little says first what is missing") {
    const std::string compile = "'" + places().compiler + "' -fsyntax-only -I'" +
                                (installed.prefix() / "include").string() + "' -I'" + places().eigen + "' '" +
                                (installed.folder() / "project/time-plain.cpp").string() + "' ";
    const auto first_error = [](const Outcome& outcome) {
      const std::size_t at = outcome.err.find("error: ");
      return at == std::string::npos ? "" : outcome.err.substr(at, outcome.err.find('\n', at) - at);
    };
    const std::string aligned = "-DEIGEN_MAX_ALIGN_BYTES=32 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 ";
    CHECK(first_error(shell(here.path(), compile + aligned + "-std=c++20")).empty());
    CHECK_THAT(first_error(shell(here.path(), compile + aligned + "-std=c++17")),
               Contains("Ricochet plugins need C++20"));
    CHECK_THAT(first_error(shell(here.path(), compile + "-std=c++20")),
               Contains("share Eigen's alignment with the program: compile through the CMake target Ricochet::plugin"));
  }

  SECTION("a stripped one still serves") {
    const std::string file = installed.plugin("leap-frog").string();
    const Outcome strip = shell(here.path(), "strip -o time-leap-frog.so '" + file + "'");
    INFO(strip.err);
    REQUIRE(strip.code == 0);  // part of binutils, which every compiler needs
    const Outcome described = installed.run(here.path(), "describe leap-frog", here.path().string());
    INFO(described.out << described.err);
    CHECK(described.code == 0);
  }

  SECTION("one that ends the program or never returns costs a study one case, and is named") {
    check_that_one_case_is_lost(installed, here);
  }
}
