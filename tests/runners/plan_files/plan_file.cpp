// Schemes that a study states itself, and those that stand as files beside the plugins.
#include "runners/plan_files/plan_file.hpp"

#include <catch2/catch.hpp>

#include "runners/kinds/trajectory/trajectory.hpp"
#include "runners/store/fingerprint.hpp"
#include "tests/runners/scratch_folder.hpp"
#include "tests/runners/study/study_fixture.hpp"

using namespace ricochet;
using namespace ricochet::tests;

namespace stated_plan_tests {
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Json theta_plan(const std::string& name, const char* order = "2") {
  Json plan = Json::parse(R"({
    "name": "",
    "parameters": {"theta": {"default": 0.5, "range": [0.5, 1]}},
    "let": {"next": "q + (1-theta)*h*v + theta*h*z"},
    "slots": {"q": [1, 0], "v": [0, 1]},
    "stages": [{
      "matrix": "M + theta*h*C + theta*theta*h*h*K",
      "history": {"q": "-h*K", "v": "M - (1-theta)*h*C - (1-theta)*theta*h*h*K"},
      "load": {"theta": "h"},
      "update": {"q": "next", "v": "z"}
    }],
    "facts": {}
  })");
  plan["name"] = name;
  plan["facts"]["order"] = order;
  return plan;
}

Json study_with(const Json& time) {
  Json study = small_study();
  study["methods"]["time"] = time;
  return study;
}

// Study, catalogue and registry of one reading.
struct Reading {
  Registry registry = stand_ins();
  Catalogue catalogue{"/nonexistent", {}, {}};
  Study study;
  Reading(const Json& json, const std::filesystem::path& folder) { read(json, folder); }
  Reading() = default;
  void read(const Json& json, const std::filesystem::path& folder) {
    study = parse_study(json.dump(1), catalogue, registry, folder);
  }
};

std::string refusal_in(const std::filesystem::path& folder, const Json& json) {
  return testing::input_error([&] { Reading(json, folder); }, "");
}

Json axis(const StudyCase& one, const std::string& name) {
  for (const auto& [key, value] : one.axes)
    if (key == name) return value;
  return "absent";
}

std::string fingerprint(const Reading& reading, std::size_t index) {
  return Fingerprints("trajectory", "program").of(reading.study.cases.at(index), {});
}

}  // namespace

TEST_CASE("a study names a plan by its file, relative to itself, and tables call it by its own name", "[plan-file]") {
  const ScratchFolder here;
  std::filesystem::create_directory(here / "plans");
  write_text(here / "plans/mine.json", theta_plan("mine").dump());
  const Reading reading(study_with({{"name", "plan"}, {"file", "plans/mine.json"}, {"theta", {0.5, 1}}}), here.path());
  REQUIRE(reading.study.cases.size() == 2 * 2 * 2);
  const StudyCase& last = reading.study.cases.back();
  CHECK(last.time.name == "mine");
  CHECK(last.time.parameters.real("theta") == 1);
  CHECK(axis(last, "time") == "mine");
  CHECK(axis(last, "time.theta") == 1);
  CHECK(reading.registry.file(Role::time, "mine") == (here / "plans/mine.json").string());
  CHECK(reading.catalogue.opened() == std::vector<std::filesystem::path>{here / "plans/mine.json"});
  // The whole choice: parameters reach the formulas.
  const auto scheme = reading.registry.time("mine")->make(last.time.parameters);
  const auto plan = scheme->plan(0.1, {});
  REQUIRE(std::holds_alternative<StepPlan>(plan));
  CHECK(std::get<StepPlan>(plan).stages[0].matrix.C == 0.1);
}

TEST_CASE("a resolved study holds its plans: it is read anywhere, and its cases are the same", "[plan-file]") {
  const ScratchFolder here, elsewhere;
  write_text(here / "mine.json", theta_plan("mine").dump());
  const Json given = study_with(Json::array({{{"name", "plan"}, {"file", "mine.json"}}, "three-level"}));
  const Reading first(given, here.path());
  const Reading again(first.study.resolved, elsewhere.path());
  REQUIRE(again.study.cases.size() == first.study.cases.size());
  for (std::size_t i = 0; i < first.study.cases.size(); ++i) {
    CHECK(again.study.cases[i].id == first.study.cases[i].id);
    CHECK(fingerprint(again, i) == fingerprint(first, i));
  }
  CHECK(again.study.resolved == first.study.resolved);
  CHECK(again.registry.file(Role::time, "mine").empty());

  // A study of one failed case alone has it as well.
  StudyResults results;
  results.name = "small";
  results.study = first.study.resolved;
  CaseRecord record;
  record.id = first.study.cases.front().id;
  record.axes = first.study.cases.front().axes;
  record.status = Status::failed;
  const Reading alone(minimal_study(results, record), elsewhere.path());
  REQUIRE(alone.study.cases.size() == 1);
  CHECK(alone.study.cases.front().time.name == "mine");
  CHECK(alone.study.cases.front().id == record.id);
}

TEST_CASE("another text of a plan makes its cases run again, and no others", "[plan-file]") {
  const ScratchFolder here;
  const Json study = study_with(Json::array({{{"name", "plan"}, {"file", "mine.json"}}, "three-level"}));
  write_text(here / "mine.json", theta_plan("mine").dump());
  const Reading before(study, here.path());
  write_text(here / "mine.json", theta_plan("mine", "1").dump());
  const Reading after(study, here.path());
  for (std::size_t i = 0; i < before.study.cases.size(); ++i) {
    CHECK(before.study.cases[i].id == after.study.cases[i].id);
    CHECK((fingerprint(before, i) == fingerprint(after, i)) == (before.study.cases[i].time.name == "three-level"));
  }
}

TEST_CASE("within a study a name stands for one scheme", "[plan-file]") {
  const ScratchFolder here;
  write_text(here / "a.json", theta_plan("mine").dump());
  write_text(here / "b.json", theta_plan("mine", "1").dump());
  write_text(here / "c.json", theta_plan("yours").dump());
  write_text(here / "d.json", theta_plan("three-level").dump());
  const auto both = [](const char* one, const char* other, double theta) {
    return study_with(
        Json::array({{{"name", "plan"}, {"file", one}}, {{"name", "plan"}, {"file", other}, {"theta", theta}}}));
  };
  CHECK(refusal_in(here.path(), both("a.json", "c.json", 1)).empty());
  CHECK(refusal_in(here.path(), both("a.json", "a.json", 1)).empty());
  CHECK_THAT(refusal_in(here.path(), both("a.json", "b.json", 1)),
             StartsWith("/methods/time/1/file: another plan of this study has the name \"mine\" already"));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "plan"}, {"file", "d.json"}})),
             StartsWith("/methods/time/file: the plan states the name \"three-level\", which the time scheme of"));
  CHECK_THAT(refusal_in(here.path(), both("a.json", "a.json", 0.5)), Contains("the same case would run twice"));
}

TEST_CASE("what is wrong with a stated plan has its place in the study and in the file", "[plan-file]") {
  const ScratchFolder here;
  Json plan = theta_plan("mine");
  plan["stages"][0]["load"] = {{"theta", "hh"}};
  write_text(here / "mine.json", plan.dump(1));
  const Json named = {{"name", "plan"}, {"file", "mine.json"}};
  CHECK_THAT(refusal_in(here.path(), study_with(named)),
             StartsWith("/methods/time/file: " + (here / "mine.json").string() + ":") &&
                 Contains(": at /stages/0/load/theta: unknown name \"hh\""));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "plan"}, {"plan", plan}})),
             StartsWith("/methods/time/plan/stages/0/load/theta: unknown name \"hh\""));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "plan"}, {"file", "absent.json"}})),
             StartsWith("/methods/time/file: ") && Contains("absent.json: cannot be read"));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "plan"}, {"fil", "mine.json"}})),
             StartsWith("/methods/time/fil: unknown key \"fil\"; did you mean \"file\"?"));
  CHECK_THAT(refusal_in(here.path(), study_with("plan")), StartsWith("/methods/time/file: missing; "));
  write_text(here / "mine.json", theta_plan("mine").dump(1));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "plan"}, {"file", "mine.json"}, {"theta", 0.2}})),
             StartsWith("/methods/time/theta: expected a number in [0.5, 1], found 0.2"));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "plan"}, {"file", "mine.json"}, {"tetha", 0.7}})),
             Contains("did you mean \"theta\"?"));
  CHECK_THAT(refusal_in(here.path(), study_with({{"name", "other"}, {"plan", theta_plan("mine")}})),
             StartsWith("/methods/time/name: expected \"plan\" or \"mine\""));
  Json two = named;
  two["plan"] = theta_plan("mine");
  CHECK_THAT(refusal_in(here.path(), study_with(two)), Contains("does not go together with \"file\""));
}

TEST_CASE("a plan beside the plugins is a scheme with the name it states", "[plan-file]") {
  const ScratchFolder here;
  Json wrong = theta_plan("wrong");
  wrong["slots"].erase("v");
  write_text(here / "mine.json", theta_plan("mine").dump(1));
  write_text(here / "other.json", R"({"name": "a study", "methods": {}})");
  write_text(here / "wrong.json", wrong.dump(1));
  write_text(here / "broken.json", "{\"slots\": {,}}");
  Reading reading;
  add_plans(here.path(), reading.catalogue);
  CHECK(reading.catalogue.names(Role::time) == std::vector<std::string>{"mine"});
  REQUIRE(reading.catalogue.unusable().size() == 2);
  CHECK(reading.catalogue.unusable()[0].file == here / "broken.json");
  CHECK_THAT(reading.catalogue.unusable()[0].reason, StartsWith("line 1:12: not valid JSON"));
  CHECK_THAT(reading.catalogue.unusable()[1].reason,
             StartsWith("line 1") && Contains(": at /let/next: unknown name \"v\""));
  CHECK(reading.catalogue.unusable_provider(Role::time, "wrong"));
  CHECK(reading.catalogue.opened().empty());

  reading.read(study_with({{"name", "mine"}, {"theta", 0.75}}), {});
  CHECK(reading.study.cases.front().time.name == "mine");
  CHECK(reading.registry.file(Role::time, "mine") == (here / "mine.json").string());
  REQUIRE(reading.study.cases.front().time.plan);
  // It is read once: what becomes of the file changes neither scheme nor fingerprint, nor what others open.
  const std::string before = fingerprint(reading, 0);
  write_text(here / "mine.json", theta_plan("mine", "1").dump(1));
  const auto order = [](Reading& one) {
    const auto scheme = one.registry.time("mine")->make(one.study.cases.front().time.parameters);
    return std::get<StepPlan>(scheme->plan(0.1, {})).facts.order;
  };
  CHECK(order(reading) == 2);
  CHECK(fingerprint(reading, 0) == before);
  Reading worker;
  add_plans(here.path(), worker.catalogue);
  worker.read(reading.study.resolved, {});
  CHECK(order(worker) == 2);
  CHECK(fingerprint(worker, 0) == before);
  Reading later;
  add_plans(here.path(), later.catalogue);
  later.read(study_with({{"name", "mine"}, {"theta", 0.75}}), {});
  CHECK(fingerprint(later, 0) != before);
  // A plan that the study states comes before one of the same name in a folder.
  Reading stated;
  add_plans(here.path(), stated.catalogue);
  stated.read(study_with({{"name", "plan"}, {"plan", theta_plan("mine", "1")}}), {});
  const auto step = stated.registry.time("mine")->make(stated.study.cases.front().time.parameters)->plan(0.1, {});
  CHECK(std::get<StepPlan>(step).facts.order == 1);
}

}  // namespace stated_plan_tests
