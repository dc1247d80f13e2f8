#pragma once
#include <catch2/catch.hpp>
#include <ricochet/contract/step_plan.hpp>

/// \file
/// n steps of h written as one step of n sub-steps.
namespace ricochet::testing {

/// Levels of sub-step k of n, in steps of n h.
inline Levels within(Levels levels, int k, int n) {
  for (Level& level : levels) level.at = (level.at + k) / n;
  return levels;
}

inline Stage sub_step(Stage stage, int k, int n) {
  const auto shift = [&](Levels& levels) { levels = within(levels, k, n); };
  shift(stage.load);
  if (stage.impact) {
    shift(stage.impact->bound);
    if (stage.impact->gate) {
      shift(stage.impact->gate->predictor_bound);
      shift(stage.impact->gate->approach_bound);
    }
  }
  for (auto& compliance : stage.compliance) {
    if (!compliance) continue;
    shift(compliance->bound);
    shift(compliance->rate_bound);
    shift(compliance->before_bound);
  }
  if (stage.work) {
    shift(stage.work->load);
    shift(stage.work->support);
  }
  return stage;
}

/// A plan of one stage and step h as one of n stages and step n h. A start rule that moves time by h is followed by the
/// other sub-steps of its step.
inline StepPlan composed(const StepPlan& plan, int n) {
  REQUIRE(plan.stages.size() == 1);
  StepPlan whole = plan;
  whole.start.clear();
  whole.stages.clear();
  for (const Stage& stage : plan.start) whole.start.push_back(sub_step(stage, 0, n));
  for (int k = 1; k < n && plan.start_advances; ++k) whole.start.push_back(sub_step(plan.stages[0], k, n));
  for (int k = 0; k < n; ++k) whole.stages.push_back(sub_step(plan.stages[0], k, n));
  return whole;
}

/// The same plan with every level of a stop left to be derived.
inline StepPlan without_stop_levels(StepPlan plan) {
  for (auto* stages : {&plan.start, &plan.stages})
    for (Stage& stage : *stages) {
      if (stage.impact) {
        stage.impact->bound.clear();
        if (stage.impact->gate) {
          stage.impact->gate->predictor_bound.clear();
          stage.impact->gate->approach_bound.clear();
        }
      }
      for (auto& compliance : stage.compliance) {
        if (!compliance) continue;
        compliance->bound.clear();
        compliance->rate_bound.clear();
        compliance->before_bound.clear();
      }
      if (stage.work) stage.work->support.clear();
    }
  return plan;
}

}  // namespace ricochet::testing
