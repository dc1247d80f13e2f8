#include <algorithm>
#include <cmath>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/engine/flight/lane_flight.hpp>
#include <ricochet/engine/marcher.hpp>

namespace ricochet {

// What a lane's spec says of its surroundings: clamp and stops, and the energies to expect.
void Marcher::place_lane(int lane) {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  energy_bounds_->place(lane, spec, stored_at_start(lane));
  clamp_.place(lane, spec.amplitude, spec.phase);
}

// What springs hold that a lane begins pressed into, J.
double Marcher::stored_at_start(int lane) const {
  if (!program_.contact || !program_.law->reads()) return 0;
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  const SparseRows& measured = program_.problem->measured();
  double sum = 0;
  for (int point = 0; point < program_.problem->points(); ++point) {
    double place = 0;
    for (SparseRows::InnerIterator entry(measured, point); entry; ++entry)
      place += entry.value() * spec.position[entry.col()];
    sum += stored(lane, point, place, spec.amplitude * std::sin(spec.phase));
  }
  return sum;
}

// The law acts from its layer on.
void Marcher::place_stops(int lane) {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  const double layer = program_.law->layer(lane);
  for (int i = 0; i < lower_.rows(); ++i) {
    lower_.at(i, lane) = spec.lower[i] + layer;
    upper_.at(i, lane) = spec.upper[i] - layer;
  }
}

// The law's parameters, one set per lane of the block.
void Marcher::prepare_law() {
  if (!program_.contact) return;
  std::vector<Parameters> parameters;
  for (int lane = 0; lane < program_.width; ++lane)
    parameters.push_back(program_.lanes[static_cast<std::size_t>(std::min(lane, lanes() - 1))].law);
  const int points = program_.problem->points();
  program_.law->prepare(points, parameters);
  const int kept = program_.law->memory_per_point();
  if (kept > 0 && memory_.rows() == 0) memory_ = Block(points * kept, program_.width);
  for (int lane = 0; lane < lanes(); ++lane)
    if (status_[static_cast<std::size_t>(lane)].running) place_stops(lane);
}

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
  if (lane_flight_) lane_flight_->forget_contact();
}

LaneState Marcher::lane_state(int lane) const {
  return state_at(lane);
}

void Marcher::set_lane(int lane, const LaneSpec& spec, const LaneState& state) {
  LaneSpec& own = program_.lanes[static_cast<std::size_t>(lane)];
  const bool same_law = own.law.values() == spec.law.values();
  const bool same_stops = own.lower == spec.lower && own.upper == spec.upper;
  own = spec;
  if (!same_law) prepare_law();
  place_lane(lane);
  status_[static_cast<std::size_t>(lane)] = LaneStatus{};
  // What the lane left behind when it stopped is gone.
  frozen_now_ &= ~(1u << lane);
  for (int k = 0; k < program_.tangents; ++k) frozen_now_ &= ~(1u << tangent_lane(lane, k));
  if (program_.contact) place_stops(lane);
  if (program_.flight && !(same_law && same_stops))
    program_.flight->place(own, program_.contact ? program_.law->layer(0) : 0);
  set_state_at(lane, state);
  if (lane_flight_) lane_flight_->forget();
}

void Marcher::set_clock(long long step) {
  step_ = step;
  // What comes depends on the state alone, whoever marched before.
  if (!lane_flight_) return;
  lane_flight_->forget();
  program_.flight->forget();
}

}  // namespace ricochet
