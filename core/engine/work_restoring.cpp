#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

/// \file
/// Stages that give back what contact took in a stage before them.
namespace ricochet {

// δ = H s + Δφ of a stage that has found z; known up to what its law leaves of the measure (now, as it says, and a
// share of what it puts right, at the beginning of the way) and round-off.
void Marcher::measure_way(const StageProgram& program, StageState& state, const double* z) {
  constexpr double round_off = 64 * std::numeric_limits<double>::epsilon(), left = 1e-9;
  std::array<const double*, most_slots + 1> slots{};
  std::copy(slot_pointers_.begin(), slot_pointers_.end(), slots.begin());
  slots[static_cast<std::size_t>(slot_count())] = z;
  const double* offset = nullptr;
  if (program_.support) {
    clamp_.offsets(program.motion_phase, offset_.data(), false);
    offset = offset_.data();
  }
  measure_rows(program_.model->contact(), slot_count() + 1, slots.data(), state.way_weights.data(), offset,
               state.way.data());
  for (const int lane : touched_) {
    double corrected = 0, size = 0;
    for (int i = 0; i < lower_.rows(); ++i) {
      const double p = state.effort[0].at(i, lane);
      if (p == 0) continue;
      const double bound = p > 0 ? lower_.at(i, lane) : upper_.at(i, lane), free = state.free.at(i, lane);
      corrected = std::max(corrected, std::abs(free - bound) + std::abs(state.way.at(i, lane)));
      size = std::max(size, std::abs(free) + std::abs(bound));
    }
    state.way_error.at(0, lane) =
        4 * outcome_[static_cast<std::size_t>(lane)].residual + left * corrected + round_off * size;
  }
}

// p_i y_i = −λ_i δ_i, with λ and δ of the stage before, in the place of a law.
void Marcher::restore_work(const StageProgram& program, StageState& state) {
  const StageState& source = *state.restored;
  for (const int lane : touched_) {
    RestoringSolver::Lane problem;
    problem.reach = program.measure_z * program.effort[0];
    problem.free = state.free.data() + lane;
    problem.pushed = source.effort[0].data() + lane;
    problem.way = source.way.data() + lane;
    problem.uncertainty = source.way_error.at(0, lane);
    problem.stride = program_.width;
    outcome_[static_cast<std::size_t>(lane)] =
        state.restoring.solve(*state.delassus, problem, state.effort[0].data() + lane, lower_.rows());
  }
}

}  // namespace ricochet
