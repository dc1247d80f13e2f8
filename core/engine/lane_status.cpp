#include <fmt/format.h>

#include <cmath>
#include <ricochet/engine/lane_status.hpp>

namespace ricochet {

std::string text(const LaneEnd& end) {
  switch (end.cause) {
    case EndCause::none:
      break;
    case EndCause::position_not_finite:
      return "the displacement at a contact point is not finite";
    case EndCause::effort_not_finite:
      return "a contact effort is not finite";
    case EndCause::law_not_converged:
      if (std::isinf(end.value))
        return "the contact law has no finite force at the state that the step reaches: take a smaller step, or a "
               "scheme (or an evaluation) whose step knows the force while it moves";
      if (end.count == 0) return fmt::format("the contact law found no solution (residual {:.3g})", end.value);
      return fmt::format("the contact law did not converge (residual {:.3g} after {} iterations)", end.value,
                         end.count);
    case EndCause::state_not_finite:
      return fmt::format("the state is not finite (lanes are checked every {} steps)", end.count);
    case EndCause::elastic_energy_beyond:
      return fmt::format("the elastic energy {:.3g} J passed {:.3g} J, {:g} times the scene's own scale", end.value,
                         end.bound, end.factor);
    case EndCause::energy_not_finite:
      return "the energy is not finite";
    case EndCause::energy_beyond:
      return fmt::format("the energy {:.3g} J passed the bound {:.3g} J", end.value, end.bound);
    case EndCause::idle:
      return "idle";
    case EndCause::twin_met:
      return "the twin fell on its orbit";
    case EndCause::process_ended:
      return "the process that marched it ended";
  }
  return {};
}

}  // namespace ricochet
