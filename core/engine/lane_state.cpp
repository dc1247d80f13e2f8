#include <cmath>
#include <ricochet/engine/marcher_state.hpp>

namespace ricochet {

LaneState Marcher::state_at(int column) const {
  LaneState state;
  for (const Block& block : blocks_)
    for (int i = 0; i < block.rows(); ++i) state.slots.push_back(block.at(i, column));
  for (const auto& stage : stage_states_) {
    if (!stage->delassus) continue;
    for (const Block& effort : stage->effort)
      for (int i = 0; i < effort.rows(); ++i) state.efforts.push_back(effort.at(i, column));
    if (stage->fastest.rows() > 0) state.fastest.push_back(stage->fastest.at(0, column));
  }
  for (int i = 0; i < memory_.rows(); ++i) state.memory.push_back(memory_.at(i, column));
  return state;
}

void Marcher::set_state_at(int column, const LaneState& state) {
  const double* slot = state.slots.data();
  for (Block& block : blocks_)
    for (int i = 0; i < block.rows(); ++i) block.at(i, column) = *slot++;
  const double* effort = state.efforts.data();
  const double* fastest = state.fastest.data();
  for (auto& stage : stage_states_) {
    if (!stage->delassus) continue;
    bool active = false;
    for (std::size_t k = 0; k < stage->effort.size(); ++k)
      for (int i = 0; i < stage->effort[k].rows(); ++i) {
        stage->effort[k].at(i, column) = *effort++;
        active = active || (k == 0 && stage->effort[0].at(i, column) != 0);
      }
    if (stage->fastest.rows() > 0) stage->fastest.at(0, column) = *fastest++;
    if (column >= lanes()) continue;
    stage->contact_lanes &= ~(1u << column);
    stage->contact_lanes |= static_cast<std::uint32_t>(active) << column;
  }
  const double* memory = state.memory.data();
  for (int i = 0; i < memory_.rows(); ++i) memory_.at(i, column) = *memory++;
  combined_for_ = nullptr;
}

LaneState Marcher::lane_state(int lane) const {
  return state_at(lane);
}

void Marcher::set_lane(int lane, const LaneSpec& spec, const LaneState& state) {
  LaneSpec& own = program_.lanes[static_cast<std::size_t>(lane)];
  const bool same_law = own.law.values() == spec.law.values();
  own = spec;
  place_lane(lane);
  if (!same_law) prepare_law();
  status_[static_cast<std::size_t>(lane)] = LaneStatus{};
  // What the lane left behind when it stopped is gone.
  frozen_now_ &= ~(1u << lane);
  for (int k = 0; k < program_.tangents; ++k) frozen_now_ &= ~(1u << tangent_lane(lane, k));
  if (program_.contact) place_stops(lane);
  set_state_at(lane, state);
}

void Marcher::set_clock(long long step) {
  step_ = step;
}

}  // namespace ricochet
