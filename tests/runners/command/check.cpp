// `ricochet check`: what it takes, and what it answers.
#include <catch2/catch.hpp>

#include "tests/runners/command/spoken_command.hpp"

using namespace command_tests;

namespace {

// The generalised mid-point rule: of first order for θ > ½.
std::string theta_plan(const std::string& order) {
  return R"json({
    "name": "theta-rule",
    "parameters": {"theta": {"default": 0.75, "range": [0.6, 1]}},
    "let": {"next": "q + (1-theta)*h*v + theta*h*z"},
    "slots": {"q": [1, 0], "v": [0, 1]},
    "stages": [{
      "matrix": "M + theta*h*C + theta*theta*h*h*K",
      "history": {"q": "-h*K", "v": "M - (1-theta)*h*C - (1-theta)*theta*h*h*K"},
      "load": {"0": "h*(1-theta)",
         "1" : "h*theta"
},
    "update" : {
  "q" : "next", "v" : "z"
}
}],
    "facts": {"order": )json" +
         order + "}}\n";
}

}  // namespace

TEST_CASE("check takes a plan by its file, by its name and by --plugin, and measures it", "[command]") {
  const Folder here;
  fs::create_directory(here / "sound");
  here.write("sound/theta.json", theta_plan("1"));
  here.write("wrong.json", theta_plan("2"));
  const std::string folder = "RICOCHET_PLUGIN_PATH='" + (here / "sound").string() + "'";
  for (const auto& [words, environment] :
       {std::pair("check sound/theta.json", std::string()), std::pair("check theta-rule", folder),
        std::pair("check theta-rule --plugin sound/theta.json", std::string()),
        std::pair("check --plugin sound/theta.json", std::string())}) {
    const Outcome outcome = here.run(words, environment);
    INFO(words << "\n" << outcome.out << outcome.err);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.out, StartsWith("time theta-rule (") && Contains("order and start     ok"));
  }
  for (const char* words : {"check wrong.json", "check --plugin wrong.json"}) {
    const Outcome outcome = here.run(words);
    INFO(words << "\n" << outcome.out << outcome.err);
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.out, Contains("order and start     FAILS") && Contains("declares order 2"));
  }
}

TEST_CASE("check says what is wrong with what it cannot check", "[command]") {
  const Folder here;
  here.write("torn.json", "{\"name\": \"torn\", \"slots\": ");
  here.write("study.json", tiny().dump(2));
  here.write("typo.json",
             R"({"name": "typo", "slots": {"q": [1, 0]}, "stages": [{"matrx": "M"}], "facts": {"order": 1}})");
  for (const auto& [words, part] :
       {std::pair("check", "expected the name of a method, a file, or --plugin FILE"),
        std::pair("check nowhere.json", "there is no file nowhere.json"), std::pair("check torn.json", "torn.json:1"),
        std::pair("check study.json", "unknown key \"question\""),
        std::pair("check typo.json", "did you mean \"matrix\"?"),
        std::pair("check newmrk", "did you mean \"newmark\"?")}) {
    const Outcome outcome = here.run(words);
    INFO(words << "\n" << outcome.out << outcome.err);
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, Contains(part));
  }
}
