#pragma once

#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <ricochet/contract/step_plan.hpp>

using namespace ricochet;

namespace step_plan_tests {
using Catch::Matchers::Contains;

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

// A three-level scheme with h = 0.1 that fills everything that a plan may say.
inline StepPlan full_plan() {
  StepPlan plan;
  plan.slots = {"q", "d"};
  plan.initial = {{1, 0}, {0, 0.1}};
  plan.velocity = {.slots = {0, 10}};
  Stage stage;
  stage.matrix = {100, 5, 0.25};
  stage.history = {{0, 0, -1}, {0, -10, 0}};
  stage.load = {{1, 0.25}, {0, 0.5}, {-1, 0.25}};
  stage.impact = {{.slots = {1, 1}, .z = 1}, {{1, 1}}, std::nullopt};
  for (auto& compliance : stage.compliance)
    compliance = {{.slots = {1, 0.5}, .z = 0.5}, {{1, 0.5}, {0, 0.5}}, {.slots = {0, 10}}, {{0, 1}}, {0.25, 0.5, 0.25}};
  stage.at(Evaluation::conserving)->before = Combination{.slots = {1, -0.5}};
  stage.at(Evaluation::conserving)->before_bound = {{0, 0.5}, {-1, 0.5}};
  stage.update = {{.slots = {1, 1}, .z = 1}, {.slots = {0, 1}, .z = 1}};
  stage.work = {{.slots = {0, 1}, .z = 0.5}, {.slots = {0, 10}}, {{0, 1}}, {1}, {{1, 1}, {0, -1}}};
  stage.loss = {{EnergyMatrix::K, 0.1, {.slots = {0, 1}, .z = 1}}};
  plan.stages = {stage};
  Stage start;
  start.update = {{.slots = {1, 1}}, {.slots = {0, 1}}};
  plan.start = {start};
  plan.start_advances = true;
  plan.energy = {{QuadraticTerm::Matrix::M, 50, {0, 1}}, {QuadraticTerm::Matrix::K, 0.5, {1, -0.5}}};
  plan.facts.stability_limit = 2;
  return plan;
}

inline StepPlan gated_plan() {
  StepPlan plan = full_plan();
  ImpactMeasure& impact = *plan.stages[0].impact;
  impact.value = {.slots = {0, 10}, .z = 10};
  impact.gate = VelocityGate{{.slots = {1, 0.5}}, {{0.5, 1}}, {.slots = {0, 10}}, {{0, 1}}, 0.8};
  return plan;
}

// The same, with a second stage that gives the work of the first one back.
inline StepPlan restoring_plan() {
  StepPlan plan = full_plan();
  plan.stages[0].loss.clear();
  Stage back;
  back.matrix = {100, 0, 0};
  back.work = WorkForm{.displacement = {.slots = {0, 1}, .z = 0.5}, .rate = {}, .load = {}};
  back.impact = ImpactMeasure{.value = back.work->displacement, .restores = 1};
  back.update = {{.slots = {1}}, {.slots = {0, 1}, .z = 1}};
  plan.stages.push_back(back);
  return plan;
}

struct Fault {
  const char* sentence;
  std::function<void(StepPlan&)> make;
};

inline std::string wrong(StepPlan plan, const Fault& fault) {
  fault.make(plan);
  return check_plan(plan).value_or("nothing");
}

}  // namespace step_plan_tests
