#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/engine/flight/lane_flight.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <ricochet/scene/stop_parameters.hpp>

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
  std::vector<double> places;
  for (int point = 0; point < program_.problem->points(); ++point) {
    double place = 0;
    for (SparseRows::InnerIterator entry(measured, point); entry; ++entry)
      place += entry.value() * spec.position[entry.col()];
    places.push_back(place + (spec.amplitude * std::sin(spec.phase) + motions().point(point, 0)));
  }
  return stored(lane, places.data());
}

// The law acts from its layer on.
void Marcher::place_stops(int lane) {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  for (int i = 0; i < lower_.rows(); ++i) {
    const double layer = program_.law->layer(program_.law_set(i, lane));
    lower_.at(i, lane) = spec.lower[i] + layer;
    upper_.at(i, lane) = spec.upper[i] - layer;
  }
  if (!circles_.any()) return;
  for (int i = 0; i < lower_.rows(); ++i) {
    law_lower_.at(i, lane) = lower_.at(i, lane);
    law_upper_.at(i, lane) = upper_.at(i, lane);
  }
  // Within a square no point passes its circle.
  for (const int first : circles_.circles()) {
    const double layer = program_.law->layer(program_.law_set(first, lane));
    put_square(spec.lower, spec.upper, first, layer, [&](int point, double low, double high) {
      lower_.at(point, lane) = low;
      upper_.at(point, lane) = high;
    });
  }
}

// The law's parameters, one set per lane of the block, or per point and lane.
void Marcher::prepare_law() {
  if (!program_.contact) return;
  std::vector<Parameters> parameters;
  for (int lane = 0; lane < program_.width; ++lane)
    parameters.push_back(program_.lanes[static_cast<std::size_t>(std::min(lane, lanes() - 1))].law);
  const int points = program_.problem->points();
  ricochet::prepare_law(*program_.law, points, parameters, program_.problem->own);
  if (program_.friction)
    program_.friction->prepare(static_cast<int>(program_.problem->rubbing.size()), program_.problem->rubbed.count());
  const int kept = program_.law->memory_per_point();
  if (kept > 0 && memory_.rows() == 0) memory_ = Block(points * kept, program_.width);
  const bool all_keep = std::all_of(program_.stages.begin(), program_.stages.end(),
                                    [](const StageProgram& stage) { return stage.keeps_memory; });
  if (kept > 0 && !all_keep && memory_before_.rows() == 0) memory_before_ = memory_apart_ = memory_;
  circles_.prepare(points, program_.width, program_.problem->circles(), kept);
  if (circles_.any() && law_lower_.rows() == 0) {
    law_lower_ = lower_;
    law_upper_ = upper_;
  }
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
  for (int i = 0; rubbing_ && i < rubbing_->sticks.rows(); ++i) state.memory.push_back(rubbing_->sticks.at(i, column));
  for (int i = 0; rubbing_ && i < rubbing_->kept.rows(); ++i) state.memory.push_back(rubbing_->kept.at(i, column));
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
        active = active || ((k == 0 || column >= lanes()) && stage->effort[k].at(i, column) != 0);
      }
    if (stage->fastest.rows() > 0) stage->fastest.at(0, column) = *fastest++;
    if (column >= lanes()) {
      // Efforts of steps before that a tangent brings act in the next step: it looks at contact.
      if (active) stage->contact_lanes |= 1u << (column % lanes());
      continue;
    }
    stage->contact_lanes &= ~(1u << column);
    stage->contact_lanes |= static_cast<std::uint32_t>(active) << column;
  }
  const double* memory = state.memory.data();
  for (int i = 0; i < memory_.rows(); ++i) memory_.at(i, column) = *memory++;
  for (int i = 0; rubbing_ && i < rubbing_->sticks.rows(); ++i) rubbing_->sticks.at(i, column) = *memory++;
  for (int i = 0; rubbing_ && i < rubbing_->kept.rows(); ++i) rubbing_->kept.at(i, column) = *memory++;
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
  if (program_.flight && !(same_law && same_stops)) program_.flight->place(own, program_.farthest_layer());
  set_state_at(lane, state);
  if (lane_flight_) lane_flight_->forget();
}

void Marcher::set_clock(long long step) {
  if (step < step_) clamp_.expect(step_ + check_interval);
  step_ = step;
  // What comes depends on the state alone, whoever marched before.
  if (!lane_flight_) return;
  lane_flight_->forget();
  program_.flight->forget();
}

namespace {

// Row by row, all lanes at once: down the columns of a wide block every number is another cache line.
template <int Lanes>
void add_rows(const Block& q, const Block& force, int first, double* energies) {
  double sum[Lanes] = {};
  for (int i = 0; i < q.rows(); ++i) {
    const double *a = q.row(i) + first, *b = force.row(i) + first;
    for (int lane = 0; lane < Lanes; ++lane) sum[lane] += 0.5 * a[lane] * b[lane];
  }
  for (int lane = 0; lane < Lanes; ++lane) energies[first + lane] = sum[lane];
}

void add_products(const Block& q, const Block& force, double* energies) {
  if (q.lanes() == 1) return add_rows<1>(q, force, 0, energies);
  for (int first = 0; first < q.lanes(); first += q.lanes() < 8 ? 2 : 8)
    q.lanes() < 8 ? add_rows<2>(q, force, first, energies) : add_rows<8>(q, force, first, energies);
}

// x − x is zero, or not a number where x is not finite.
bool finite(const Block& block) {
  double sum[8] = {};
  const double* x = block.data();
  std::size_t e = 0;
  for (; e + 8 <= block.size(); e += 8)
    for (std::size_t k = 0; k < 8; ++k) sum[k] += x[e + k] - x[e + k];
  for (; e < block.size(); ++e) sum[0] += x[e] - x[e];
  bool all = true;
  for (const double nothing : sum) all = all && nothing == 0;
  return all;
}

}  // namespace

// K times the first slot.
void Marcher::push_back() {
  if (program_.kind == OperatorKind::sparse)
    return kernels_.row_product(RowMatrix::symmetric(program_.model->stiffness()), false, slots_[0], elastic_.data());
  BandStep step;
  step.rows = program_.model->rows();
  step.product_width = stiffness_width_;
  step.K = stiffness_band_.data();
  step.k = slots_[0];
  step.b = elastic_.data();
  kernels_.band_step(step);
}

void Marcher::check_lanes() {
  push_back();
  std::array<double, 32> energies{};
  add_products(blocks_[0], elastic_, energies.data());
  bool all_finite = true;
  for (std::size_t j = 1; j < blocks_.size(); ++j) all_finite = all_finite && finite(blocks_[j]);
  for (int lane = 0; lane < lanes(); ++lane) {
    if (!status_[static_cast<std::size_t>(lane)].running) continue;
    const double energy = energies[static_cast<std::size_t>(lane)];
    bool sound = std::isfinite(energy);
    for (std::size_t j = 1; j < blocks_.size() && !all_finite && sound; ++j)
      for (int i = 0; i < blocks_[j].rows(); ++i) sound = sound && std::isfinite(blocks_[j].at(i, lane));
    if (!sound)
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
  clamp_.stop(lane);
  for (int i = 0; i < memory_.rows(); ++i) memory_.at(i, lane) = 0;
  for (int i = 0; rubbing_ && i < rubbing_->sticks.rows(); ++i) rubbing_->sticks.at(i, lane) = 0;
  for (int i = 0; rubbing_ && i < rubbing_->kept.rows(); ++i) rubbing_->kept.at(i, lane) = 0;
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

Said told(const LaneEnd& end) {
  switch (end.cause) {
    case EndCause::none:
      break;
    case EndCause::position_not_finite:
      return Said("the displacement at a contact point is not finite");
    case EndCause::effort_not_finite:
      return Said("a contact effort is not finite");
    case EndCause::law_not_converged:
      if (std::isinf(end.value))
        return Said(
            "the contact law has no finite force at the state that the step reaches: take a smaller step. "
            "Otherwise use a scheme, or an evaluation, whose step knows the force while it moves");
      if (end.count == 0) return said("the contact law found no solution (residual {:.3g})", end.value);
      return said("the contact law did not converge (residual {:.3g} after {} iterations)", end.value, end.count);
    case EndCause::friction_not_found:
      return said("friction and normal force were not found together (residual {:.3g} after {} turns)", end.value,
                  end.count);
    case EndCause::state_not_finite:
      return said("the state is not finite (lanes are checked every {} steps)", end.count);
    case EndCause::elastic_energy_beyond:
      return said("the elastic energy {:.3g} J passed {:.3g} J, {:g} times the scene's own scale", end.value, end.bound,
                  end.factor);
    case EndCause::energy_not_finite:
      return Said("the energy is not finite");
    case EndCause::energy_beyond:
      return said("the energy {:.3g} J passed the bound {:.3g} J", end.value, end.bound);
    case EndCause::idle:
      return Said("idle");
    case EndCause::twin_met:
      return Said("the twin fell on its orbit");
    case EndCause::process_ended:
      return Said("the process that marched it ended");
  }
  return {};
}

std::string text(const LaneEnd& end) {
  return told(end).text;
}

}  // namespace ricochet
