#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <ricochet/contact_solvers/restoring_solver.hpp>
#include <ricochet/engine/stage_delassus.hpp>
#include <ricochet/engine/step_observer.hpp>
#include <ricochet/kernels/block.hpp>
#include <utility>
#include <vector>

namespace ricochet {

/// Which stage of a step stands `place` stages after the first of a step, and how many steps before it. Negative places
/// are in the steps before.
std::pair<int, std::size_t> place_in_steps(std::ptrdiff_t place, std::ptrdiff_t stages);

/// What a Marcher keeps of a stage between steps, and the constants of its loop.
struct StageState {
  std::unique_ptr<StageDelassus> delassus;  ///< null: the stage reads no contact
  std::vector<Block> effort;  ///< p of this stage, then of 1, 2, … steps ago as far as anyone weights it
  /// p, p₋₁, p₋₂, …: this stage, the one before it, …; null: no contact there
  std::vector<const double*> effort_pointers;
  std::unique_ptr<StageImpulse> impulse;  ///< null: no effort moves a second unknown
  Block w;                                ///< that unknown, rows × T; zero where nothing jumped
  bool jumped = false;                    ///< whether something did, in some lane
  Block free, weighted, rate, before, gap, gate_lower, gate_upper, approach;
  std::vector<double> rebound;           ///< of a gate, e of each point's stop
  Block fastest;                         ///< largest speed seen at a closed point, per lane
  std::uint32_t contact_lanes = 0;       ///< lanes with a non-zero effort
  std::uint32_t closed_lanes = 0;        ///< lanes with a closed gate
  std::uint32_t touched_lanes = 0;       ///< lanes that the law looked at in this stage
  std::vector<double> update;            ///< slots × (slots + 1)
  std::vector<double> update_w;          ///< of each slot, the weight of w
  bool increments = false;               ///< whether the update is x_1 ← x_1 + z, x_0 ← x_0 + x_1
  std::optional<PointTest> test;         ///< where the operator measures what the law reads
  SquareSum* sum = nullptr;              ///< what the operator adds up for an observer
  StageView view;                        ///< what an observer is shown
  Block end_rate;                        ///< u° of rows that rub, rows × T
  std::vector<double> end_rate_weights;  ///< over those of the slots and z that have one
  std::vector<std::size_t> end_rate_of;  ///< which these are
  std::vector<const double*> columns;    ///< of W, once asked for: of points, then of rows that rub
  std::vector<double> couples;           ///< of these rows, with their column: the largest that it has of a point
  std::vector<double> measure_weights, rate_weights, before_weights, gap_weights, approach_weights;
  std::vector<int> contact_age;  ///< steps of contact so far, points × T; only where tangents wait
  ActiveSystem tangents;         ///< of the lane whose tangents are being corrected
  // Of a stage whose work another one gives back:
  Block way, way_error;  ///< δ against the stops, points × T, and what is not known of it, 1 × T; m
  std::vector<double> way_weights;
  // Of the one that gives it back:
  const StageState* restored = nullptr;
  RestoringSolver restoring;
};

}  // namespace ricochet
