// `ricochet check`: what it takes, and what it answers.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "tests/places.hpp"
#include "tests/runners/command/spoken_command.hpp"

using ricochet::tests::places;
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

TEST_CASE("check measures the order without damping and beside a stop too", "[command]") {
  const Folder here;
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
  };
  // The trapezoidal rule, but for a term of h² where nothing is damped, or where there is a stop.
  const std::string sound = replaced(theta_plan("\"theta == 0.5 ? 2 : 1\""), R"("default": 0.75, "range": [0.6, 1])",
                                     R"("default": 0.5, "range": [0.5, 1])");
  for (const auto& [name, fact, where] :
       {std::tuple("undamped", "damped ? 0 : 0.1", "on the oscillator without damping"),
        {"touching", "contact ? 0.1 : 0", "beside a stop that it never meets"}}) {
    std::string plan = replaced(sound, "theta*theta*h*h*K", fmt::format("theta*theta*h*h*K + ({})*h*h*K", fact));
    if (std::string(name) == "touching")
      plan = replaced(plan, "\"load\"", R"("impact": {"value": "next", "effort": ["h"]}, "load")");
    here.write(std::string(name) + ".json", plan);
    const Outcome outcome = here.run(fmt::format("check {}.json", name));
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.out, Contains("order and start     FAILS") && Contains(where));
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

TEST_CASE("new plan makes a plan that passes its check and runs in its study", "[command]") {
  const Folder here;
  const Outcome made = here.run("new plan my-rule");
  INFO(made.out << made.err);
  REQUIRE(made.code == 0);
  CHECK_THAT(made.out, Contains("my-rule.json") && Contains("study.json") && Contains("check my-rule/my-rule.json"));
  CHECK_THAT(read(here / "my-rule/study.json"), Contains("my-rule.json") && !Contains("theta-rule"));
  const Outcome checked = here.run("check my-rule/my-rule.json");
  INFO(checked.out << checked.err);
  CHECK(checked.code == 0);
  const Outcome run = here.run("run my-rule/study.json --out results");
  INFO(run.out << run.err);
  CHECK(run.code == 0);
  CHECK_THAT(read(here / "results/cases.csv"), Contains("my-rule"));
  CHECK(here.run("new plan my-rule").code == 2);
  const Outcome taken = here.run("new plan plan");
  CHECK(taken.code == 2);
  CHECK_THAT(taken.err, Contains("a name of its own"));
  CHECK_THAT(here.run("new plan newmark").err, Contains("there is a time method \"newmark\" already"));
}

TEST_CASE("what no plugin provides is told with where it was looked for", "[command]") {
  const Folder here;
  auto study = tiny();
  study["methods"]["time"] = "my-scheme";
  here.write("study.json", study.dump(2));
  here.write("theta.json", theta_plan("1"));
  fs::create_directory(here / "mine");
  const Outcome outcome = here.run("plan study.json --plugin theta.json", "RICOCHET_PLUGIN_PATH=mine:nowhere");
  INFO(outcome.err);
  CHECK(outcome.code == 4);
  CHECK_THAT(outcome.err, Contains("study.json:") &&
                              Contains("at /methods/time: no plugin provides the time scheme \"my-scheme\"") &&
                              Contains("looked in ") &&
                              Contains("lib/ricochet, mine, nowhere (no such folder), theta.json"));
  CHECK_THAT(here.run("check my-scheme").err, Contains("looked in "));
  // A slip of the study's writer, where another name is near.
  study["methods"]["time"] = "newmrk";
  here.write("study.json", study.dump(2));
  const Outcome slip = here.run("plan study.json");
  CHECK(slip.code == 2);
  CHECK_THAT(slip.err, Contains("did you mean \"newmark\"?"));
}

TEST_CASE("a study of stability says where the limit that a scheme declares is another", "[command]") {
  const Folder here;
  // Newmark with β = 0.1 and γ = ½ is stable up to h·ω = 2.582.
  const auto ended = [&](const char* limit, double damping) {
    std::string plan = read(places().source + "/plugins/plan_files/newmark.json");
    const std::string right = "\"2*beta < gamma ? 1/sqrt(gamma/2-beta) : none\"";
    plan.replace(plan.find(right), right.size(), limit);
    here.write("plan.json", plan);
    nlohmann::ordered_json study = nlohmann::ordered_json::parse(R"({
      "name": "limits", "question": "How far?", "kind": "stability",
      "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                              "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}}},
      "mesh": {"elements": 4},
      "methods": {"mass": "consistent", "contact": "none", "time": {"name": "plan", "file": "plan.json", "beta": 0.1}},
      "steps": {"from": 1e-5, "to": 1e-2, "count": 7}})");
    if (damping > 0) study["scene"]["structure"]["damping"] = {{"stiffness", damping}};
    here.write("limits.json", study.dump(2));
    return here.run("run limits.json --fresh --out results");
  };
  const std::string told = "the step limit is not the one that the scheme declares";
  for (const char* wrong : {"3.5", "2", "null"}) {
    const Outcome outcome = ended(wrong, 0);
    INFO(wrong << "\n" << outcome.out << outcome.err);
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.out, Contains(told));
    CHECK_THAT(read(here / "results/cases.csv"), Contains("undeclared_limit"));
  }
  const char* is_so = "\"2*beta < gamma ? 1/sqrt(gamma/2-beta) : none\"";
  const Outcome right = ended(is_so, 0), damped = ended(is_so, 1e-5);
  INFO(right.out << right.err << damped.out << damped.err);
  CHECK(right.code == 0);
  CHECK(damped.code == 0);
  CHECK_THAT(right.out + damped.out, !Contains(told));
}
