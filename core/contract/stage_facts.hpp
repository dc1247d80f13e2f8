#pragma once
#include <ricochet/contract/step_plan.hpp>
#include <string>
#include <vector>

/// \file
/// What follows from the numbers of a plan and need not be declared. It is found by marching a free unit mass. Of each
/// stage: when it stands, what it moves the position by, its levels of stops. Momenta: momentum_weights.hpp.
namespace ricochet {

/// The rate at the end of a stage over the slots before it and its unknowns, m/s. What a surface does, X(t), stands in it
/// as Σ w X'(t + c h) + Σ v X(t + c h).
struct EndRate {
  Combination rate;  ///< 1 on a mass at 1 m/s, 0 at rest
  Levels speeds;     ///< (c, w)
  Levels places;     ///< (c, v), v in 1/s: of rates that are means over the stage

  /// Whether there is one, which the stage's own effort moves.
  bool known() const { return rate.z != 0 || rate.w != 0; }
};

/// One stage. Times are in steps, from the time when the step begins.
struct StageFacts {
  double from = 0, to = 1;  ///< where the position stands before and after the stage
  /// When contact is asked: `to` where the stage moves the position, else the latest level of its stop.
  double instant = 1;
  Combination increment;  ///< position after − position before, without cancellation
  /// The first of these that is one and that z or w moves: what a gate closes, the plan's velocity after the stage, the
  /// rate of the implicit evaluation, the mean over what the position moves by. Friction opposes it.
  EndRate end_rate;
};

/// A plan with what was left to be derived filled in, and the facts of its stages.
struct DerivedPlan {
  StepPlan plan;  ///< levels of stops complete
  /// The step that the plan was made for, s: what a free mass at 1 m/s moves by. 0 where an S that solves something, or
  /// an R, has no M. Nothing is derived then: each stage stands at the end of the step, and so does what was left out.
  double h = 0;
  std::vector<StageFacts> start, stages;
  /// Where plan.velocity stands after a step, in steps. 0: at its end. −½: it is a mean over the step. Of several
  /// sub-steps it is a mean over the last one: minus half of its length.
  double velocity_offset = 0;
  /// The slot that holds what the position moved by in the latest stage; −1: none does. Looked for only where the step
  /// has one stage, and its start one at the most.
  int increment_slot = -1;
};

/// DerivedPlan::h alone.
double step_of(const StepPlan& plan);

/// Fills in what a well-formed plan leaves out.
DerivedPlan derive(StepPlan plan);

/// What is wrong with the motion of a free unit mass at rest or at constant speed; "" when nothing is. Wrong as well:
/// levels, velocity or test displacements measured on it. For check_plan(), which has looked at sizes before.
std::string inconsistent_motion(const StepPlan& plan);

/// Weights of efforts in the equations of one stage. `weights`: π₀, π₁, … in that of z, none where the stage reads no
/// contact. `impulse`: ι in that of w.
struct StageEffort {
  std::vector<double> weights;
  double impulse = 0;  ///< 0 where the stage has no impulse
};
/// Those of each stage, as a law that reads this evaluation (none: a rigid law) meets them.
using StageEfforts = std::vector<StageEffort>;
StageEfforts stage_efforts(const std::vector<Stage>& stages, const std::optional<Evaluation>& evaluation);

}  // namespace ricochet
