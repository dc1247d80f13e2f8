#pragma once
#include <string>
#include <vector>

namespace ricochet {

/// What one lane carries from step to step, in model coordinates: enough to go on elsewhere with bitwise equal results.
struct LaneState {
  std::vector<double> slots;    ///< slot by slot
  std::vector<double> efforts;  ///< per stage its p, and those of steps before where the plan weights them
  std::vector<double> fastest;  ///< per stage with a gate: the largest speed seen at its stops, m/s
  std::vector<double> memory;   ///< of the law, per point
};

/// Why the integration of a lane ended.
enum class EndCause {
  none,                   ///< it runs
  position_not_finite,    ///< the displacement at a contact point
  effort_not_finite,      ///< that a contact law found
  law_not_converged,      ///< value: residual, in units of the measure, ∞: no finite force; count: iterations made
  state_not_finite,       ///< count: steps between two checks of the state
  elastic_energy_beyond,  ///< value: ½wᵀKw, J; bound, J: factor times the scene's own scale
  energy_not_finite,      ///< of an audit
  energy_beyond,          ///< value: energy of an audit, J; bound, J
  idle,                   ///< nothing is marched there
  twin_met,               ///< a twin trajectory fell on its orbit
  process_ended,          ///< that of the integration, for a reason of its own
};

/// The end of an integration: its cause, with the numbers that the cause tells of.
struct LaneEnd {
  EndCause cause = EndCause::none;
  double value = 0, bound = 0, factor = 0;
  long long count = 0;

  /// Whether there is one.
  explicit operator bool() const { return cause != EndCause::none; }
  /// Whether the step itself could not be made: then the integration has failed. Otherwise it went where no motion of
  /// the scene goes: it has diverged.
  bool failed() const { return cause == EndCause::law_not_converged || cause == EndCause::process_ended; }
  bool operator==(const LaneEnd&) const = default;
};

/// The cause in words, with its numbers: "the contact law did not converge (residual 0.3 after 50 iterations)"; "" for
/// none.
std::string text(const LaneEnd& end);

/// How a lane fares. A lane that diverges is frozen at zero, out of every stop's reach, and the others go on.
struct LaneStatus {
  bool running = true;
  long long step = 0;  ///< when it stopped
  double time = 0;     ///< s
  LaneEnd end;
};

}  // namespace ricochet
