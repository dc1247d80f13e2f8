// Every documented way to state a plan, run in every way: one process, workers, parts, a case alone. The tables are
// one.
#include "tests/runners/command/spoken_command.hpp"
#include "tests/runners/same_tables.hpp"

namespace every_way_tests {
using namespace command_tests;
using Json = nlohmann::ordered_json;

namespace {

// Newmark with β = ¼, γ = ½, or another γ; the name of a parameter of its own.
Json plan_text(const std::string& gamma) {
  Json plan = Json::parse(R"({
    "name": "my-newmark", "parameters": {"beta": {"default": 0.25, "range": [0, 0.5]}}, "let": {},
    "slots": {"q": [1, 0], "v": [0, 1], "a": [0, 0]},
    "start": [{"matrix": "M", "history": {"q": "-K", "v": "-C"}, "load": {"0": 1}, "update": {"a": "z"}}],
    "stages": [{"matrix": "M + gamma*h*C + beta*h*h*K",
                "history": {"q": "-K", "v": "-C - h*K", "a": "-(1-gamma)*h*C - (0.5-beta)*h*h*K"},
                "load": {"1": 1}, "impact": {"value": "next"},
                "update": {"q": "next", "v": "v + (1-gamma)*h*a + gamma*h*z", "a": "z"}}],
    "facts": {"order": "gamma == 0.5 ? 2 : 1"}
  })");
  plan["let"] = {{"gamma", gamma}, {"next", "q + h*v + (0.5-beta)*h*h*a + beta*h*h*z"}};
  return plan;
}

Json study_with(const std::string& kind, const Json& time) {
  Json study = tiny();
  study["kind"] = kind;
  study["methods"]["mass"] = "consistent";
  study["methods"]["time"] = Json::array({time, "newmark"});
  if (kind == "convergence") {
    study["step"] = {4e-4, 2e-4};
    study["reference"] = "self";
  }
  return study;
}

// How a study names the plan, and what the command needs besides.
struct Form {
  std::string name;
  Json time;
  std::string options = {}, environment = {};
};

// The plan lies in the folder `plans` beside the study.
std::vector<Form> forms(const Folder& here) {
  const Json beta = {{"beta", {0.25, 0.3}}};
  const auto with = [&](Json entry) {
    entry.update(beta);
    return entry;
  };
  return {
      {"relative", with({{"name", "plan"}, {"file", "plans/mine.json"}})},
      {"absolute", with({{"name", "plan"}, {"file", (here / "plans/mine.json").string()}})},
      {"here", with({{"name", "plan"}, {"plan", plan_text("0.5")}})},
      {"by-its-name", with({{"name", "my-newmark"}, {"plan", plan_text("0.5")}})},
      {"in-a-folder", with({{"name", "my-newmark"}}), "", "RICOCHET_PLUGIN_PATH='" + (here / "plans").string() + "'"},
      {"relative-folder", with({{"name", "my-newmark"}}), "", "RICOCHET_PLUGIN_PATH=plans"},
      {"option", with({{"name", "my-newmark"}}), " --plugin plans/mine.json"},
  };
}

}  // namespace

TEST_CASE("a plan runs alike however it is stated and wherever its cases run", "[plan-file]") {
  const Folder here;
  fs::create_directory(here / "plans");
  here.write("plans/mine.json", plan_text("0.5").dump(1));
  const auto run = [&](const Form& form, const std::string& words) {
    const Outcome said = here.run(words + form.options, form.environment);
    INFO(form.name << ": " << words << "\n" << said.err << said.out);
    CHECK(said.code == 0);
    return said;
  };
  const std::vector<Form> all = forms(here);
  here.write("study.json", study_with("trajectory", all[0].time).dump());
  run(all[0], "run study.json --inline --out alone");
  for (const Form& form : all) {
    const std::string out = form.name + "-workers";
    here.write(form.name + "-study.json", study_with("trajectory", form.time).dump());
    run(form, "run " + form.name + "-study.json --isolate --jobs 2 --out " + out);
    INFO(form.name);
    same_tables::check_same(here / "alone", here / out);
  }
  // A run goes on where another one has ended, with workers or without.
  CHECK_THAT(run(all[0], "run study.json --isolate --jobs 2 --out alone").out, Contains("3 kept"));
  // What is stored needs neither file nor folder.
  for (const char* out : {"relative-workers", "in-a-folder-workers"}) {
    const auto rows = same_tables::rows_of(here / (std::string(out) + "/cases.csv"));
    REQUIRE_FALSE(rows.empty());
    CHECK_THAT(here.run(std::string("case ") + out + " " + rows.front().at("case")).out,
               Contains("as stored to the last bit"));
  }
  // Parts that are merged where no file is.
  for (const char* part : {"1", "2"})
    run(all[0], std::string("run study.json --isolate --part ") + part + "/2 --out part-" + part);
  fs::rename(here / "plans", here / "elsewhere");
  run(all[2], "merge part-1 part-2 --out merged");
  same_tables::check_same(here / "alone", here / "merged");
}

TEST_CASE("a plan whose C has the wrong sign fails its cases by name, whatever the kind of study", "[plan-file]") {
  const Folder here;
  Json plan = plan_text("0.5");
  plan["stages"][0]["matrix"] = "M - gamma*h*C + beta*h*h*K";
  here.write("wrong.json", plan.dump(1));
  for (const std::string kind : {"trajectory", "stability", "bifurcation"}) {
    Json study = study_with(kind, {{"name", "plan"}, {"file", "wrong.json"}});
    study["scene"]["structure"]["damping"]["stiffness"] = 1e-2;
    if (kind != "trajectory") study.erase("step"), study.erase("samples");
    if (kind == "stability") study["steps"] = {{"from", 1e-5}, {"to", 1e-4}, {"count", 2}};
    if (kind == "bifurcation") {
      study.erase("duration");
      study["scene"].erase("initial");
      study["scene"]["support"] = {{"amplitude", 0.08}, {"pulsation", 10}};
      study.update(Json::parse(R"({
        "parameter": {"pointer": "/scene/support/amplitude", "from": 0.07, "to": 0.08, "count": 2},
        "steps_per_period": 2000, "transient": {"periods": 16, "at_most": 32}, "keep": 16, "section": "strobe"})"));
    }
    here.write("study.json", study.dump());
    const Outcome said = here.run("run study.json --inline --table --out " + kind);
    INFO(kind << "\n" << said.err << said.out);
    CHECK(said.code == 3);
    bool named = false;
    for (const auto& row : same_tables::rows_of(here / (kind + "/cases.csv")))
      if (row.at("time") == "my-newmark") {
        CHECK(row.at("status") == "failed");
        CHECK_THAT(row.at("reason"), Contains("plugin time 'my-newmark'") && Contains("S is indefinite") &&
                                         Contains("the plan weighs C by -"));
        named = true;
      }
    CHECK(named);
  }
}

TEST_CASE("a convergence study, which workers run, knows a plan by its file, from another folder", "[plan-file]") {
  const Folder here;
  fs::create_directories(here / "studies/plans");
  fs::create_directory(here / "elsewhere");
  here.write("studies/plans/mine.json", plan_text("0.5").dump(1));
  const Json time = {{"name", "plan"}, {"file", "plans/mine.json"}};
  here.write("studies/converges.json", study_with("convergence", time).dump());
  const auto run = [&](const std::string& out, const std::string& how) {
    const Outcome said = here.run("run studies/converges.json --jobs 2 --out " + out + how);
    INFO(said.err << said.out);
    REQUIRE(said.code == 0);
  };
  run("alone", " --inline");
  run("workers", " --isolate");
  same_tables::check_same(here / "alone", here / "workers");
}

}  // namespace every_way_tests
