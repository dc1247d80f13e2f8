#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/contract/step_plan.hpp>

/// \file
/// n steps of h written as one step of n sub-steps.
namespace ricochet::testing {

/// Levels of sub-step k of n, in steps of n h.
inline Levels within(Levels levels, int k, int n) {
  for (Level& level : levels) level.at = (level.at + k) / n;
  return levels;
}

/// Does something to every combination of a stage but its updates.
template <class Change>
void each_measure(Stage& stage, Change&& change) {
  if (stage.impact) {
    change(stage.impact->value);
    if (stage.impact->gate) {
      change(stage.impact->gate->predictor);
      change(stage.impact->gate->approach);
    }
  }
  for (auto& one : stage.compliance) {
    if (!one) continue;
    change(one->displacement);
    change(one->rate);
    if (one->before) change(*one->before);
  }
  if (stage.work) {
    change(stage.work->displacement);
    change(stage.work->rate);
  }
  for (LossTerm& term : stage.loss) change(term.value);
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

/// The steps alone: the levels of a start rule hold on the motion that it starts, which its numbers do not tell.
inline StepPlan steps_of(StepPlan plan) {
  plan.start.clear();
  plan.start_advances = false;
  return plan;
}

/// Whether all stops of two stages have the same levels. `rates`: also those of rates where compliance is explicit.
/// What a step knows of its end when it begins is a velocity of neither.
inline void check_same_stops(const Stage& a, const Stage& b, bool rates = true) {
  const auto weight = [](const Levels& levels, double at) {
    double sum = 0;
    for (const Level& level : levels) sum += std::abs(level.at - at) < 1e-9 ? level.weight : 0.0;
    return sum;
  };
  const auto same = [&](const Levels& x, const Levels& y) {
    for (const Levels* either : {&x, &y})
      for (const Level& level : *either) CHECK(weight(x, level.at) == Approx(weight(y, level.at)).margin(1e-9));
  };
  REQUIRE(a.impact.has_value() == b.impact.has_value());
  if (a.impact && (rates || !a.impact->gate)) same(a.impact->bound, b.impact->bound);
  if (a.impact && a.impact->gate) {
    same(a.impact->gate->predictor_bound, b.impact->gate->predictor_bound);
    if (rates) same(a.impact->gate->approach_bound, b.impact->gate->approach_bound);
  }
  for (const auto evaluation :
       {Evaluation::implicit_end, Evaluation::averaged, Evaluation::explicit_start, Evaluation::conserving}) {
    if (!a.at(evaluation)) continue;
    INFO(evaluation_word(evaluation));
    same(a.at(evaluation)->bound, b.at(evaluation)->bound);
    // A mean of two levels before the step stands where their middle does: the same to second order.
    CHECK(a.at(evaluation)->before_bound.empty() == b.at(evaluation)->before_bound.empty());
    if (rates && evaluation != Evaluation::explicit_start)
      same(a.at(evaluation)->rate_bound, b.at(evaluation)->rate_bound);
  }
  if (a.work && rates) same(a.work->support, b.work->support);
}

}  // namespace ricochet::testing
