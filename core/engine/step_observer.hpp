#pragma once
#include <cstdint>
#include <ricochet/engine/compile.hpp>
#include <span>

namespace ricochet {

class Marcher;
struct SkippedSteps;

/// What an observer sees while a step is made. Blocks are rows × T or points × T.
struct StageView {
  int stage = 0;
  const Stage* plan = nullptr;
  const StageProgram* program = nullptr;  ///< what was derived of the stage
  bool starting = false;                  ///< a stage of the start rule
  double time = 0;                        ///< when the step begins, s
  double from = 0, to = 0;                ///< when the position stands before and after the stage, s
  const double* const* slots = nullptr;   ///< before the stage
  const double* z = nullptr;              ///< the stage's unknown, efforts included
  const double* w = nullptr;              ///< its second one; null: nothing jumped
  const double* const* effort = nullptr;  ///< p, p₋₁, … as far as the plan weights them; null: no contact
  int efforts = 0;                        ///< how many; each may be null: a stage that reads no contact
  const LaneOutcome* outcome = nullptr;   ///< per lane, of the law; of lanes that were looked at
  std::uint32_t touched_lanes = 0;        ///< lanes that the law looked at
  const double* free = nullptr;           ///< what the law measured before any effort, absolute; null where nothing did
  std::uint32_t contact_lanes = 0;        ///< lanes with a non-zero effort now
  std::span<const int> pushed;            ///< points with a non-zero effort now, in any of them, ascending
  const SquareSum* sum = nullptr;  ///< what an observer asked for, of z as it is now; null where efforts moved it
};

/// Steps of one lane in which no stop was looked at and that nobody was shown: what is known of each.
struct QuietSteps {
  struct Step {
    double sine = 0, cosine = 1;      ///< of ωt, when it began
    double form = 0, projection = 0;  ///< of the squares that the observer asked for; 0 where it asked for none
    double tip = 0;                   ///< absolute displacement when it began, m; 0 where the observer does not read it
  };
  std::span<const Step> steps;
  double last = 0;  ///< when the last of them began, s
};

/// Looks at every step of a block; a march without an observer pays nothing for it.
class StepObserver {
 public:
  virtual ~StepObserver() = default;
  /// Squares that it would see added up in each free step of a stage of the plan, if its operator sums_squares(); null:
  /// none. Asked when a march begins or goes on, and kept until it returns.
  virtual SquareSum* squares(int /*stage*/) { return nullptr; }
  /// Whether it reads QuietSteps::Step::tip. Asked as squares() are.
  virtual bool reads_tip() const { return false; }
  /// The stage has found z and p; the slots are not yet updated.
  virtual void stage_solved(const Marcher& marcher, const StageView& view) = 0;
  /// The step is complete.
  virtual void step_done(Marcher& marcher) = 0;
  /// How many steps from now on it need not be shown, as long as contact stays what it is: it is told of them by
  /// skipped(), and the step after them is shown, with the same contact unless Flight::tells_slots(). None, unless it
  /// says otherwise.
  virtual long long may_skip(const Marcher& /*marcher*/) { return 0; }
  /// Steps were left out; the marcher stands at their end.
  virtual void skipped(Marcher& /*marcher*/, const SkippedSteps& /*steps*/) {}
  /// The next step (counted as Marcher::step() after it) that has to be shown whatever happens in it. Those before it
  /// need not be, as long as no stage looks at a stop: it is told of them by quiet(), before the next one that is shown
  /// and before march() returns. Asked when a march begins or goes on, and after each step that was shown.
  virtual long long next_shown(const Marcher& /*marcher*/) { return 0; }
  virtual void quiet(const Marcher& /*marcher*/, const QuietSteps& /*steps*/) {}
};

}  // namespace ricochet
