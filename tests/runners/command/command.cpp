#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/runners/command/spoken_command.hpp"

namespace command_tests {

TEST_CASE("Help and version are answers, not errors") {
  const Folder here;
  for (const char* words : {"--help", "-h", "help"}) {
    const Outcome outcome = here.run(words);
    CHECK(outcome.code == 0);
    for (const char* name : {"run", "plan", "list", "describe", "new", "check", "report", "compare", "export", "point",
                             "schema", "doctor", "130"})
      CHECK_THAT(outcome.out, Contains(name));
  }
  CHECK_THAT(here.run("--version").out, StartsWith("ricochet "));
  const Outcome help = here.run("help help");
  CHECK(help.code == 0);
  CHECK_THAT(help.out, StartsWith("Usage: ricochet help"));
  for (const char* name : {"run", "plan", "list", "describe", "new", "check", "report", "compare", "export", "point",
                           "schema", "doctor"}) {
    const Outcome first = here.run(std::string(name) + " --help"), second = here.run(std::string("help ") + name);
    CHECK(first.code == 0);
    CHECK(first.out == second.out);
    CHECK_THAT(first.out, StartsWith(std::string("Usage: ricochet ") + name));
  }
}

TEST_CASE("Wrong usage ends with 2 and the nearest name") {
  const Folder here;
  const std::vector<std::pair<std::string, std::string>> all = {
      {"", "expected a command"},
      {"paln x.json", "did you mean \"plan\"?"},
      {"--hlep", "did you mean --help?"},
      {"help paln", "did you mean \"plan\"?"},
      {"run", "ricochet: an argument of run is missing\nUsage: ricochet run"},
      {"run a.json b.json", "does not expect \"b.json\""},
      {"run a.json --job 2", "did you mean --jobs?"},
      {"run a.json --jobs two", "whole number"},
      {"run a.json --jobs 0", "outside [1, "},
      {"run a.json --jobs", "--jobs"},
      {"run a.json --out", "--out"},
      {"plan a.json --fresh", "plan has no option --fresh; `ricochet run` has --fresh\n"},
      {"plan a.json --jbos=2", "plan has no option --jbos; `ricochet run` has --jobs\n"},
      {"list mas", "did you mean \"mass\"?"},
      {"describe singlar", "did you mean \"singular\"?"},
      {"export somewhere", "--to CSVDIR"},
      {"schema x", "does not expect \"x\""},
  };
  for (const auto& [words, part] : all) {
    INFO(words);
    const Outcome outcome = here.run(words);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, StartsWith("ricochet: ") && Contains(part));
  }
}

TEST_CASE("A bad study ends with 2, file and line, and nothing is written") {
  const Folder here;
  const auto refused = [&](const std::string& name, const std::string& start, const std::string& part) {
    for (const std::string command : {"plan", "run"}) {
      INFO(command << " " << name);
      const Outcome outcome = here.run(command + " " + name);
      CHECK(outcome.code == 2);
      CHECK(outcome.out.empty());
      CHECK_THAT(outcome.err, StartsWith(start));
      CHECK_THAT(outcome.err, Contains(part));
      CHECK_FALSE(fs::exists(here / "results"));
    }
  };
  refused("missing.json", "missing.json: cannot be read", "No such file");
  fs::create_directory(here / "folder.json");
  refused("folder.json", "folder.json: is a folder", "");
  here.write("empty.json", "");
  refused("empty.json", "empty.json:1:1: the file is empty", "");
  here.write("broken.json", "{\n  \"name\": \"x\",\n}\n");
  refused("broken.json", "broken.json:2:14: not valid JSON: a trailing comma",
          "\n    \"name\": \"x\",\n               ^\n");
  here.write("twice.json", "{\"name\": \"x\",\n \"name\": \"y\"}");
  refused("twice.json", "twice.json:2: at /name: this key is given twice", "");
  nlohmann::ordered_json study = tiny();
  study["scene"]["structure"]["lenght"] = 1;
  here.write("key.json", study.dump(1));
  refused("key.json", "key.json:" + line_of(study.dump(1), "lenght") + ": at /scene/structure/lenght: unknown key",
          "did you mean \"length\"?");
  study = tiny();
  study["scene"]["initial"]["displacement"] = "0.04*x^2 +";
  here.write("formula.json", study.dump(1));
  refused("formula.json",
          "formula.json:" + line_of(study.dump(1), "\"displacement\"") + ": at /scene/initial/displacement: ",
          "does not parse");
  study = tiny();
  study["methods"]["time"][0]["name"] = "newmark-dumont";
  here.write("plugin.json", study.dump(1));
  refused("plugin.json", "plugin.json:", "did you mean \"newmark-dumont-paoli\"?");
  study = tiny();
  study["step"] = {1e-4, -1};
  here.write("step.json", study.dump(1));
  refused("step.json", "step.json:", "at /step/1: expected a number in ]0, ∞[");
}

TEST_CASE("Plugins are listed and described from their own manuals") {
  const Folder here;
  const Outcome all = here.run("list"), masses = here.run("list mass");
  CHECK(all.code == 0);
  for (const char* name : {"consistent", "lumped", "singular", "none", "signorini", "penalty", "augmented-lagrangian",
                           "newmark-dumont-paoli", "newmark", "moreau-jean"})
    CHECK_THAT(all.out, Contains(name));
  CHECK_THAT(masses.out, Contains("singular") && !Contains("signorini"));
  const Outcome penalty = here.run("describe penalty");
  CHECK(penalty.code == 0);
  CHECK_THAT(penalty.out, Contains("stiffness") && Contains("N/m") && Contains("required") && Contains("source: "));
  const Outcome scheme = here.run("describe newmark-dumont-paoli");
  CHECK(scheme.code == 0);
  CHECK_THAT(scheme.out,
             Contains("restitution") && Contains("order ") && Contains("stability") && Contains("stage 1: S z = b"));
}

TEST_CASE("What a study and its results call by a name has a manual too, and the nearest name is one of all") {
  const Folder here;
  const std::vector<std::pair<std::string, std::vector<std::string>>> all = {
      {"beam", {"/scene/structure/type", "length", "section.outer_diameter", "young", "Pa", "required"}},
      {"tube", {"/scene/structure/section/type", "wall"}},
      {"trajectory", {"/kind", "duration", "samples", "step", "or a list"}},
      {"basins", {"/kind", "axes.pointer"}},
      {"impulse", {"impulse (a measure of a case, in N s): ", "error.impulse"}},
      {"tip-l2", {"error.tip-l2 (a measure of a case, in m): Root mean square"}},
      {"error.tip-l2", {"Root mean square"}},
      {"ask", {"threshold", "From which value of an axis on", "each entry has one verb"}},
      {"rank", {"rank (a verb of asks): ", "over", "required"}},
      {"study", {"In the measure's unit. (with limit)", "It is below this value. (with threshold)"}},
  };
  for (const auto& [name, parts] : all) {
    const Outcome outcome = here.run("describe " + name);
    INFO(name << outcome.err);
    CHECK(outcome.code == 0);
    for (const std::string& part : parts) CHECK_THAT(outcome.out, Contains(part));
  }
  for (const auto& [wrong, right] : std::vector<std::pair<std::string, std::string>>{{"baem", "beam"},
                                                                                     {"trajectroy", "trajectory"},
                                                                                     {"impluse", "impulse"},
                                                                                     {"tip-l3", "tip-l2"},
                                                                                     {"treshold", "threshold"}}) {
    const Outcome outcome = here.run("describe " + wrong);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, StartsWith("ricochet: no method, structure, kind, ask, measure or error is called") &&
                                Contains("did you mean \"" + right + "\"?"));
  }
}

}  // namespace command_tests
