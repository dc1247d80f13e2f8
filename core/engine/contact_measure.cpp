#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/algebra/flight_kernels.hpp>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/engine/flight/lane_flight.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

namespace ricochet {

// Rows times Σ_k w_k x_k, and an offset per lane. Where flights leave out steps, the rows of one lane are dense: what
// they have in common is summed once.
void Marcher::measure_rows(const RowMatrix& rows, int terms, const double* const* x, const double* weights,
                           const double* offset, double* out) {
  if (!program_.flight || program_.width > 1) {
    kernels_.measure(rows.view(), terms, x, weights, offset, out);
    return;
  }
  const int n = program_.model->rows();
  // Modes keep no combination for the step to come: its block is free.
  kernels_.combine(n, terms, x, weights, combination_.data());
  flight_kernels().dots(n, rows.rows(), rows.value.data(), combination_.data(), out);
  for (int i = 0; offset && i < rows.rows(); ++i) out[i] += offset[0];
}

// Gap test and approach test: a side that is open has an infinite bound; a closed one may rebound.
void Marcher::open_gates(StageProgram& program, StageState& state, std::span<const double* const> terms) {
  const VelocityGate& gate = *program.gate;
  const int points = lower_.rows(), T = program_.width;
  const double* offset = nullptr;
  const auto measure = [&](const std::vector<double>& weights, const PhaseWeights& phase, bool rate, Block& out) {
    if (program_.support) {
      clamp_.offsets(phase, offset_.data(), rate);
      offset = offset_.data();
    }
    const int count = slot_count() + (weights.back() != 0);
    measure_rows(program_.model->measured(), count, terms.data(), weights.data(), offset, out.data());
  };
  measure(state.gap_weights, program.predictor_phase, false, state.gap);
  state.closed_lanes = 0;
  for (int lane = 0; lane < T; ++lane) {
    bool closed = false;
    for (int i = 0; i < points; ++i)
      closed = closed || state.gap.at(i, lane) <= lower_.at(i, lane) || state.gap.at(i, lane) >= upper_.at(i, lane);
    state.closed_lanes |= static_cast<std::uint32_t>(closed) << lane;
  }
  if (state.closed_lanes == 0) return;
  measure(state.approach_weights, program.approach_phase, true, state.approach);
  for (int lane = 0; lane < T; ++lane) {
    if (!((state.closed_lanes >> lane) & 1u)) continue;
    double& fastest = state.fastest.at(0, lane);
    for (int i = 0; i < points; ++i) fastest = std::max(fastest, std::abs(state.approach.at(i, lane)));
    const double still = 1e-10 * fastest;
    for (int i = 0; i < points; ++i) {
      const double gap = state.gap.at(i, lane), speed = state.approach.at(i, lane);
      const bool lower = gap <= lower_.at(i, lane), upper = gap >= upper_.at(i, lane);
      const double from_lower = speed > still ? -speed : -gate.restitution * std::min(speed, 0.0);
      const double from_upper = speed < -still ? -speed : -gate.restitution * std::max(speed, 0.0);
      state.gate_lower.at(i, lane) = lower ? from_lower : -infinity;
      state.gate_upper.at(i, lane) = upper ? from_upper : infinity;
    }
  }
  for (int i = 0; i < points; ++i)
    for (int lane = 0; lane < T; ++lane)
      if (!((state.closed_lanes >> lane) & 1u)) {
        state.gate_lower.at(i, lane) = -infinity;
        state.gate_upper.at(i, lane) = infinity;
      }
}

// What the law reads in every lane; a bit for each lane beyond a bound.
std::uint32_t Marcher::measure_contact(StageProgram& program, StageState& state, const double* z) {
  state.closed_lanes = 0;
  if (lane_flight_ && lane_flight_->clear() && state.contact_lanes == 0) return 0;
  if (state.test) return state.test->outside;
  std::array<const double*, most_slots + 1> slots{};
  std::copy(slot_pointers_.begin(), slot_pointers_.end(), slots.begin());
  slots[static_cast<std::size_t>(slot_count())] = z;
  const bool gated = program.gate.has_value();
  if (gated) {
    open_gates(program, state, slots);
    if (state.closed_lanes == 0 && state.contact_lanes == 0) return 0;
    if (state.closed_lanes == 0) {
      state.gate_lower.fill(-infinity);
      state.gate_upper.fill(infinity);
    }
  }
  // Work is given back where some was taken, and nowhere else.
  if (state.restored && (state.restored->contact_lanes | state.contact_lanes) == 0) return 0;
  const double* offset = nullptr;
  if (program_.support) {
    clamp_.offsets(program.measure_phase, offset_.data(), gated);
    offset = offset_.data();
  }
  measure_rows(program_.model->measured(), slot_count() + 1, slots.data(), state.measure_weights.data(), offset,
               state.free.data());
  if (state.rate.rows() > 0) {
    if (program_.support) clamp_.offsets(program.rate_phase, offset_.data(), true);
    measure_rows(program_.model->measured(), slot_count() + 1, slots.data(), state.rate_weights.data(), offset,
                 state.rate.data());
  }
  if (state.before.rows() > 0) {
    if (program_.support) clamp_.offsets(program.before_phase, offset_.data(), false);
    measure_rows(program_.model->measured(), slot_count() + 1, slots.data(), state.before_weights.data(), offset,
                 state.before.data());
  }
  if (state.restored) return state.restored->contact_lanes;
  const Block& lower = gated ? state.gate_lower : lower_;
  const Block& upper = gated ? state.gate_upper : upper_;
  std::uint32_t outside = kernels_.outside(lower_.rows(), state.free.data(), lower.data(), upper.data());
  // A mean over the step may push a point that leaves its stop within it, whether or not it was pushed before.
  if (state.before.rows() > 0)
    outside |= kernels_.outside(lower_.rows(), state.before.data(), lower.data(), upper.data());
  return outside;
}

}  // namespace ricochet
