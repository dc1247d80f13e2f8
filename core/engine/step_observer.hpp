#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <ricochet/engine/compile.hpp>
#include <span>
#include <vector>

namespace ricochet {

class Marcher;
struct StageFriction;
struct StepInterval;

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
  const StageFriction* friction = nullptr;  ///< of these lanes; its efforts stand behind those of the points
  const double* free = nullptr;           ///< what the law measured before any effort, absolute; null where nothing did
  std::uint32_t contact_lanes = 0;        ///< lanes with a non-zero effort now
  std::span<const int> pushed;            ///< points with a non-zero effort now, in any of them, ascending
  const SquareSum* sum = nullptr;  ///< what an observer asked for, of z as it is now; null where efforts moved it
};

/// Sees the steps of a block. An integration without observers pays nothing for them.
class StepObserver {
 public:
  static constexpr long long never = std::numeric_limits<long long>::max();

  /// What it asks of an integration. It keeps this up to date; the marcher reads it when an integration begins or goes
  /// on, and after each call.
  struct Asks {
    /// The next step (counted as Marcher::step() after it) that it must be shown whatever happens in it. Those before
    /// it are told by interval(): steps that flights leave out, and marched ones in which no stage looks at a stop. A
    /// call comes before the next step that is shown, and before march() returns. 0: every step is shown.
    long long next_shown = 0;
    bool tip = false;  ///< whether it reads the tip in marched steps of an interval
    /// Of each stage of the plan: squares that it would see added up in free steps, if its operator sums_squares().
    /// Null or none: it needs none. One observer of an integration gets them.
    std::vector<SquareSum*> squares;
  };

  virtual ~StepObserver() = default;
  /// The stage has found z and p; the slots are not yet updated.
  virtual void stage_solved(const Marcher& marcher, const StageView& view) = 0;
  /// The step is complete.
  virtual void step_done(Marcher& marcher) = 0;
  /// Steps were made or left out that it was not shown; the marcher stands at their end, or where a shown step begins.
  virtual void interval(Marcher& /*marcher*/, const StepInterval& /*steps*/) {}

  const Asks& asks() const { return asks_; }

 protected:
  Asks asks_;
};

/// The observers of an integration, in the order in which they are told. Refers to them.
class Observers {
 public:
  Observers() = default;
  Observers(StepObserver* one) { add(one); }
  Observers(std::initializer_list<StepObserver*> all) {
    for (StepObserver* const one : all) add(one);
  }
  /// Null adds nobody.
  void add(StepObserver* one) {
    if (!one) return;
    if (count_ == few_.size()) many_.assign(few_.begin(), few_.end());
    if (count_ < few_.size())
      few_[count_] = one;
    else
      many_.push_back(one);
    ++count_;
  }
  bool empty() const { return count_ == 0; }
  StepObserver* const* begin() const { return many_.empty() ? few_.data() : many_.data(); }
  StepObserver* const* end() const { return begin() + count_; }
  /// The next step that one of them has to be shown.
  long long next_shown() const {
    long long next = StepObserver::never;
    for (const StepObserver* one : *this) next = next < one->asks().next_shown ? next : one->asks().next_shown;
    return next;
  }

 private:
  std::size_t count_ = 0;
  std::array<StepObserver*, 8> few_{};  // these take no memory from the heap
  std::vector<StepObserver*> many_;     // all of them, where they are more
};

/// A step of one lane that was marched and not shown: no stage of it looked at a stop.
struct FreeStep {
  double sine = 0, cosine = 1;      ///< of ωt, when it began
  double form = 0, projection = 0;  ///< of the squares that an observer asked for; 0 where none did
  double tip = 0;                   ///< absolute displacement after it, m; 0 where no observer reads it
};

}  // namespace ricochet
