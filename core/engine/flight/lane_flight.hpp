#pragma once
#include <algorithm>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <vector>

namespace ricochet {

/// What a flight has to know of the lane that a marcher steps, in the marcher's own storage.
struct FlownLane {
  const Program& program;
  std::span<const std::unique_ptr<StageState>> stages;
  std::span<double* const> slots;  ///< rows × T
  const Block& memory;             ///< of the law
};

/// The flights of one lane. It follows from step to step which points are closed. A Flight leaves out the steps in
/// which that stays as it is.
class LaneFlight {
 public:
  /// To be asked once before every step: whether it may be left out. Not where efforts of steps before still act.
  bool follow(const FlownLane& lane);
  /// Whether as many as `most` steps may pay. Right after follow(), where that says so.
  bool due(const FlownLane& lane, long long most) {
    return most >= Flight::least && lane.program.flight->due(lane.program, closed_);
  }
  /// Leaves out steps before the next one, `most` at most; returns how many. `e` drives the lane, see FlightDrive.
  /// `told` is filled but for its time. Where due().
  long long leave_out(const FlownLane& lane, const double* e, long long most, bool works, StepInterval& told);
  /// What comes depends on the state alone.
  void forget() { open_steps_ = clear_ = 0; }
  /// Efforts have changed, whatever acted before is gone.
  void forget_contact() { open_steps_ = 0; }

  /// Whether the step under way is known to touch no stop; step_made() after each.
  bool clear() const { return clear_ > 0; }
  void step_made() { clear_ = std::max(clear_ - 1, 0LL); }

 private:
  bool find_closed(const FlownLane& lane);
  void connect(const FlownLane& lane);
  void gather(const FlownLane& lane);
  void scatter(const FlownLane& lane) const;

  int settles_after_ = 0;     // steps after which no effort acts any more
  long long open_steps_ = 0;  // steps without contact
  long long clear_ = 0;       // steps to come of which a flight has seen that no point closes in them
  std::vector<ClosedPoint> closed_;
  std::vector<std::vector<double*>> past_;  // efforts of each stage, and of steps before
  // Slots by column, where a flight takes tangents along: numbers, and pointers to them for each column.
  std::vector<double> columns_;
  std::vector<double*> column_pointers_;
  std::vector<double* const*> column_slots_;
};

}  // namespace ricochet
