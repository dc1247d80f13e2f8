#pragma once
#include <optional>
#include <ricochet/engine/cost_model.hpp>
#include <ricochet/engine/step_observer.hpp>

#include "runners/march/prepare_case.hpp"

namespace ricochet {

/// What the steps of a march ask, counted. It is told of those that nobody has to see.
class StepCounts final : public StepObserver {
 public:
  /// `finer`: how long the steps are that it counts for, over those that it sees.
  explicit StepCounts(double finer = 1) : finer_(finer) { asks_.next_shown = never; }
  void stage_solved(const Marcher& marcher, const StageView& view) override;
  void step_done(Marcher& marcher) override;
  void interval(Marcher& marcher, const StepInterval& steps) override;

  double steps() const { return visited_ + left_out_; }
  /// Share of steps without contact that were made.
  double open() const { return (visited_ - touched_) / steps(); }
  /// Share of finer steps that are in contact: a contact lasts as long as the steps between its first and its last.
  double in_contact() const { return (touched_ + held_ - runs_ * (1 - finer_)) / steps(); }
  /// Of the steps in contact that were made: points that push, and iterations.
  ContactWork contact() const;
  /// Whether they are those of the whole duration, and not of its beginning.
  bool whole() const { return whole_; }
  void end(bool whole) { whole_ = whole; }

 private:
  void see(bool contact) {
    runs_ += contact && !before_ ? 1 : 0;
    before_ = contact;
  }

  double finer_;
  double visited_ = 0, left_out_ = 0, held_ = 0, touched_ = 0, runs_ = 0;
  double solves_ = 0, points_ = 0, iterations_ = 0;
  bool touches_ = false, before_ = false, whole_ = false;
};

/// Marches a case for at most 2000 steps, a fifth of `seconds`, which it is thought to take, and 5 ms, or a fiftieth of
/// `seconds` where that is more. In modes steps are as long as the whole duration takes, up to a hundredth of the first
/// mode's period. Nothing where the case has too few steps, a method comes from another folder, or a step went wrong.
std::optional<StepCounts> trial_march(const StudyCase& study_case, const Prepared& prepared, const Registry& registry,
                                      double seconds);

}  // namespace ricochet
