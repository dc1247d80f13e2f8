#include <array>
#include <cmath>
#include <ricochet/algebra/infinity.hpp>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

namespace ricochet {
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

void Marcher::check_lanes() {
  BandStep step;
  step.rows = program_.model->rows();
  step.product_width = stiffness_width_;
  step.K = stiffness_rows_.data();
  step.k = slots_[0];
  step.b = elastic_.data();
  kernels_.band_step(step);
  std::array<double, 32> energies{};
  add_products(blocks_[0], elastic_, energies.data());
  bool all_finite = true;
  for (std::size_t j = 1; j < blocks_.size(); ++j) all_finite = all_finite && finite(blocks_[j]);
  for (int lane = 0; lane < lanes(); ++lane) {
    if (!status_[static_cast<std::size_t>(lane)].running) continue;
    const double energy = energies[static_cast<std::size_t>(lane)];
    bool sound = std::isfinite(energy);
    for (std::size_t j = 1; j < blocks_.size() && !all_finite && sound; ++j)
      for (int i = 0; i < step.rows; ++i) sound = sound && std::isfinite(blocks_[j].at(i, lane));
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
