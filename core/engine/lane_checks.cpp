#include <cmath>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

namespace ricochet {

void Marcher::check_lanes() {
  BandStep step;
  step.rows = program_.model->rows();
  step.product_width = stiffness_width_;
  step.K = stiffness_rows_.data();
  step.k = slots_[0];
  step.b = elastic_.data();
  kernels_.band_step(step);
  for (int lane = 0; lane < lanes(); ++lane) {
    if (!status_[static_cast<std::size_t>(lane)].running) continue;
    double energy = 0;
    for (int i = 0; i < step.rows; ++i) energy += 0.5 * blocks_[0].at(i, lane) * elastic_.at(i, lane);
    bool finite = std::isfinite(energy);
    for (std::size_t j = 1; j < blocks_.size() && finite; ++j)
      for (int i = 0; i < step.rows; ++i) finite = finite && std::isfinite(blocks_[j].at(i, lane));
    if (!finite)
      freeze(lane, {.cause = EndCause::state_not_finite, .count = check_interval});
    else if (beyond_bound(lane, energy))
      freeze(lane, {.cause = EndCause::elastic_energy_beyond,
                    .value = energy,
                    .bound = energy_bound(lane),
                    .factor = EnergyBounds::factor});
  }
}

void Marcher::freeze(int lane, const LaneEnd& end) {
  LaneStatus& status = status_[static_cast<std::size_t>(lane)];
  if (!status.running) return;
  status.running = false;
  status.step = step_;
  status.time = time();
  status.end = end;
  // At rest in a still frame without stops: the lane stays there, and costs its neighbours nothing.
  frozen_now_ |= 1u << lane;
  clear_lane(lane);
  clear_efforts(lane);
  for (auto* states : {&start_states_, &stage_states_})
    for (auto& state : *states) state->contact_lanes &= ~(1u << lane);
  for (int k = 0; k < program_.tangents; ++k) {
    const int tangent = tangent_lane(lane, k);
    frozen_now_ |= 1u << tangent;
    clear_lane(tangent);
    clear_efforts(tangent);
  }
  clamp_.hold_still(lane);
  for (int i = 0; i < memory_.rows(); ++i) memory_.at(i, lane) = 0;
  for (int i = 0; i < lower_.rows(); ++i) {
    lower_.at(i, lane) = -infinity;
    upper_.at(i, lane) = infinity;
  }
}

void Marcher::clear_lane(int lane) {
  for (Block& block : blocks_)
    for (int i = 0; i < block.rows(); ++i) block.at(i, lane) = 0;
  combined_for_ = nullptr;
}

void Marcher::clear_efforts(int column) {
  for (auto* states : {&start_states_, &stage_states_})
    for (auto& state : *states)
      for (Block& effort : state->effort)
        for (int i = 0; i < effort.rows(); ++i) effort.at(i, column) = 0;
}

}  // namespace ricochet
