#include "runners/run/alike_cases.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "tests/runners/run/fake_study.hpp"

using namespace ricochet;

namespace {

StudyCase some_case() {
  StudyCase one = fake_study(1).cases.front();
  one.scene_json = {{"support", {{"amplitude", 0.02}, {"pulsation", 10}}}, {"load", "x"}};
  one.elements = 10;
  return one;
}

}  // namespace

TEST_CASE("cases that differ in the size of the scene's numbers alone cost alike, others do not") {
  const StudyCase one = some_case();
  StudyCase other = one;
  other.id = "other";
  other.scene_json["support"]["amplitude"] = 0.5;
  other.axes.emplace_back("support.amplitude", 0.5);
  CHECK(cost_key(one) == cost_key(other));
  const std::vector<std::function<void(StudyCase&)>> changes = {
      [](StudyCase& c) { c.scene_json["support"]["amplitude"] = 0; },
      [](StudyCase& c) { c.scene_json["support"]["amplitude"] = nullptr; },
      [](StudyCase& c) { c.scene_json["load"] = "2*x"; },
      [](StudyCase& c) { c.mass.name = "lumped"; },
      [](StudyCase& c) { c.contact.parameters.set("stiffness", 1e5); },
      [](StudyCase& c) { c.time.name = "bathe"; },
      [](StudyCase& c) { c.elements = 11; },
      [](StudyCase& c) { c.step *= 0.5; },
      [](StudyCase& c) { c.steps_per_period = 100; },
      [](StudyCase& c) { c.duration = 2; },
      [](StudyCase& c) { c.samples = 51; },
      [](StudyCase& c) { c.march = "auto"; },
      [](StudyCase& c) {
        c.settings = {{"budget", 1}};
      },
      [](StudyCase& c) {
        c.references.push_back({"self", {}});
      }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    INFO(i);
    StudyCase changed = one;
    changes[i](changed);
    CHECK(cost_key(changed) != cost_key(one));
  }
}

TEST_CASE("a run plans one of alike cases, and goes on to the next where the first cannot be told") {
  const ScratchFolder scratch;
  Study study = fake_study(6);
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    StudyCase& one = study.cases[i];
    one.scene_json = {{"support", {{"amplitude", 1.0 + static_cast<double>(i)}}}};
    one.mass.name = i < 3 ? "first" : "second";
    one.step = 0.1;
  }
  FakeRun run(scratch);
  std::atomic<int> planned{0};
  run.runner.plan = [&](const StudyCase& one) {
    ++planned;
    CasePlan plan;
    if (one.id == study.cases[0].id) plan.refusal = "not this one";
    if (one.id == study.cases[3].id) throw std::runtime_error("no plan");
    if (one.id != study.cases[0].id) plan.predicted_seconds = one.mass.name == "first" ? 1 : 2;
    return plan;
  };
  std::vector<std::string> order;
  run.runner.cases.run = [&](const StudyCase& one, const std::atomic<bool>&) {
    order.push_back(one.mass.name);
    return fake_result(one);
  };
  RunOptions options;
  options.out = scratch.path() / "out";
  options.jobs = 1;
  CHECK(run(study, options) == 0);
  CHECK(planned == 4);
  CHECK(order == std::vector<std::string>{"second", "second", "second", "first", "first", "first"});
}
