#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/engine/flight/lane_flight.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {

// Rows times Σ_k w_k x_k, and an offset per lane. Where flights leave out steps, the rows of one lane are dense: what
// they have in common is summed once. Tangent columns are measured where something pushes alone (measure_tangents).
void Marcher::measure_rows(const RowMatrix& rows, int terms, const double* const* x, const double* weights,
                           const double* offset, double* out) {
  if (!program_.flight) {
    kernels_.measure(rows.view(), terms, x, weights, offset, out);
    return;
  }
  const int n = program_.model->rows(), T = program_.width;
  // Modes keep no combination for the step to come: its block is free.
  kernels_.combine(static_cast<long>(n) * T, terms, x, weights, combination_.data());
  if (T == 1) {
    flight_kernels().dots(n, rows.rows(), rows.value.data(), combination_.data(), out);
    for (int i = 0; offset && i < rows.rows(); ++i) out[i] += offset[0];
    return;
  }
  double *lane = scratch_.data(), *places = scratch_.data() + n;
  for (int i = 0; i < n; ++i) lane[i] = combination_.at(i, 0);
  flight_kernels().dots(n, rows.rows(), rows.value.data(), lane, places);
  for (std::ptrdiff_t i = 0; i < rows.rows(); ++i) out[i * T] = places[i] + (offset ? offset[0] : 0.0);
}

// What motions of supports by histories lift each point by, Σ_k w_k Σ_j A_ij φ_j(t + c_k h), or its rate.
void Marcher::add_motions(const Levels& levels, bool rate, Block& out) const {
  const SupportMotions& motions = this->motions();
  for (std::size_t j = 0; j < motions.histories.size(); ++j) {
    double lift = 0;
    for (const Level& level : levels) {
      const double t = time() + level.at * program_.h;
      lift += level.weight * (rate ? motions.histories[j]->rate(t) : motions.histories[j]->value(t));
    }
    for (int i = 0; i < out.rows(); ++i) {
      const double share = motions.at_points(i, static_cast<Eigen::Index>(j)) * lift;
      for (int lane = 0; lane < lanes(); ++lane) out.at(i, lane) += share;
    }
  }
}

// What round-off opens is closed: a gap this far below what the last effort of the point moves it by in a step, m.
double Marcher::gate_slack(const StageProgram& program, StageState& state, int point, int lane) {
  constexpr double round_off = 1e-10;
  const double p = state.effort[0].at(point, lane);
  if (p == 0) return 0;
  return round_off * program_.h * std::abs(program.reach * p * columns_of(state).column(point)[point]);
}

// Gap test and approach test: a side that is open has an infinite bound; a closed one may rebound.
void Marcher::open_gates(StageProgram& program, StageState& state, std::span<const double* const> terms) {
  const VelocityGate& gate = *program.gate;
  const int points = lower_.rows(), T = program_.width;
  const double* offset = nullptr;
  const auto measure = [&](const std::vector<double>& weights, const PhaseWeights& phase, const Levels& levels,
                           bool rate, Block& out) {
    if (program_.support) {
      clamp_.offsets(phase, offset_.data(), rate);
      offset = offset_.data();
    }
    const int count = slot_count() + (weights.back() != 0);
    measure_rows(program_.model->measured(), count, terms.data(), weights.data(), offset, out.data());
    add_motions(levels, rate, out);
  };
  measure(state.gap_weights, program.predictor_phase, gate.predictor_bound, false, state.gap);
  state.closed_lanes = 0;
  for (int lane = 0; lane < T; ++lane) {
    bool closed = false;
    for (int i = 0; i < points; ++i) {
      const double slack = gate_slack(program, state, i, lane);
      closed = closed || state.gap.at(i, lane) <= lower_.at(i, lane) + slack ||
               state.gap.at(i, lane) >= upper_.at(i, lane) - slack;
    }
    state.closed_lanes |= static_cast<std::uint32_t>(closed) << lane;
  }
  if (state.closed_lanes == 0) return;
  measure(state.approach_weights, program.approach_phase, gate.approach_bound, true, state.approach);
  for (int lane = 0; lane < T; ++lane) {
    if (!((state.closed_lanes >> lane) & 1u)) continue;
    double& fastest = state.fastest.at(0, lane);
    for (int i = 0; i < points; ++i) fastest = std::max(fastest, std::abs(state.approach.at(i, lane)));
    const double still = 1e-10 * fastest;
    for (int i = 0; i < points; ++i) {
      const double restitution = state.rebound[static_cast<std::size_t>(i)];
      const double gap = state.gap.at(i, lane), speed = state.approach.at(i, lane);
      const double slack = gate_slack(program, state, i, lane);
      const bool lower = gap <= lower_.at(i, lane) + slack, upper = gap >= upper_.at(i, lane) - slack;
      const double from_lower = speed > still ? -speed : -restitution * std::min(speed, 0.0);
      const double from_upper = speed < -still ? -speed : -restitution * std::max(speed, 0.0);
      // Between two closed sides what is slow is still: neither may throw it beyond the other.
      if (lower && upper && from_lower > from_upper) {
        state.gate_lower.at(i, lane) = state.gate_upper.at(i, lane) = 0;
        continue;
      }
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
    if (state.closed_lanes == 0 && state.contact_lanes == 0 && !(rubbing_ && rubbing_->always != 0)) return 0;
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
  add_motions(program.measure_levels, gated, state.free);
  if (state.rate.rows() > 0) {
    if (program_.support) clamp_.offsets(program.rate_phase, offset_.data(), true);
    measure_rows(program_.model->measured(), slot_count() + 1, slots.data(), state.rate_weights.data(), offset,
                 state.rate.data());
    add_motions(program.compliance->rate_bound, true, state.rate);
  }
  if (state.before.rows() > 0) {
    if (program_.support) clamp_.offsets(program.before_phase, offset_.data(), false);
    measure_rows(program_.model->measured(), slot_count() + 1, slots.data(), state.before_weights.data(), offset,
                 state.before.data());
    add_motions(program.compliance->before_bound, false, state.before);
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

namespace {

// Without a branch per number: x − x is zero, or not a number where x is not finite.
bool finite_in(const Block& block, int lane) {
  bool finite = true;
  for (int i = 0; i < block.rows(); ++i) {
    const double x = block.at(i, lane);
    finite &= x - x == 0;
  }
  return finite;
}

// z += S⁻¹Hᵀ p of the lanes with many efforts, each in one solve; which they are.
std::uint32_t correct_at_once(StageDelassus& delassus, const double* effort, int points, double* z, int rows, int T) {
  std::uint32_t solved = 0;
  for (int lane = 0; lane < T; ++lane) {
    int pushing = 0;
    for (int j = 0; j < points; ++j) pushing += effort[static_cast<std::ptrdiff_t>(j) * T + lane] != 0;
    if (pushing <= BoxSolver::many || !delassus.held()) continue;
    const double* response = delassus.respond(effort + lane, T);
    for (int i = 0; i < rows; ++i) z[static_cast<std::ptrdiff_t>(i) * T + lane] += response[i];
    solved |= 1u << lane;
  }
  return solved;
}

}  // namespace

// z° becomes z = z° + S⁻¹Hᵀ Σ_k π_k p₋ₖ: first with the efforts that are known, then with the one that the law finds,
// which may move w too.
void Marcher::contact(StageProgram& program, StageState& state, double* z) {
  if (state.jumped) state.w.fill(0.0);
  state.jumped = false;
  remember_efforts(program, state, z);
  state.touched_lanes = 0;
  std::uint32_t mask = measure_contact(program, state, z) | state.contact_lanes;
  if (rubbing_) mask |= rubbing_->always;
  if (mask == 0) return;
  choose_touched(state, mask);
  if (state.restored)
    restore_work(program, state);
  else
    find_efforts(program, state, z);
  keep_contact(state);
  if (program_.tangents > 0) tangent_contact(program, state, z);
  if (state.impulse) {
    if (state.contact_lanes != 0) jump(state, z);
  } else if (program.effort[0] == 1.0 && !(rubbing_ && program.friction_weight != 1.0)) {
    if (state.contact_lanes != 0) correct(state, state.effort[0].data(), pushing_, z);
  } else if ((program.effort[0] != 0 || rubbing_) && state.contact_lanes != 0) {
    const std::size_t size = state.effort[0].size(),
                      own = static_cast<std::size_t>(lower_.rows()) * static_cast<std::size_t>(program_.width);
    for (std::size_t e = 0; e < own; ++e) state.weighted.data()[e] = program.effort[0] * state.effort[0].data()[e];
    for (std::size_t e = own; e < size; ++e)
      state.weighted.data()[e] = program.friction_weight * state.effort[0].data()[e];
    correct(state, state.weighted.data(), pushing_, z);
  }
  if (state.way.rows() > 0 && state.contact_lanes != 0) measure_way(program, state, z);
}

// Those of the law, and of friction.
void Marcher::find_efforts(const StageProgram& program, StageState& state, const double* z) {
  const bool apart = !program.keeps_memory && memory_before_.rows() > 0;
  if (apart) {
    std::copy_n(memory_before_.data(), memory_.size(), memory_apart_.data());
    std::swap(memory_, memory_apart_);
  }
  if (rubbing_ && memory_.rows() > 0) rubbing_->memory.assign(memory_.data(), memory_.data() + memory_.size());
  solve_law(program, state, touched_);
  if (rubbing_) rub(program, state, z);
  if (apart) std::swap(memory_, memory_apart_);
}

DelassusColumns& Marcher::columns_of(StageState& state) {
  if (state.impulse) return *state.impulse;
  return *state.delassus;
}

// z += S⁻¹Hᵀ p, column by column of the points where some lane has an effort; a lane that has many, in one solve.
void Marcher::correct(StageState& state, const double* effort, std::span<const int> pushing, double* z) {
  const int rows = program_.model->rows(), T = program_.width, points = lower_.rows();
  const std::uint32_t solved =
      points > BoxSolver::many ? correct_at_once(*state.delassus, effort, points, z, rows, T) : 0;
  alignas(64) double others[32];
  for (const int j : pushing) {
    const double* p = effort + static_cast<std::size_t>(j) * static_cast<std::size_t>(T);
    if (solved != 0) {
      for (int lane = 0; lane < T; ++lane) others[lane] = (solved >> lane & 1u) != 0 ? 0.0 : p[lane];
      p = others;
      if (std::none_of(p, p + T, [](double x) { return x != 0; })) continue;
    }
    kernels_.add_column(rows, state.delassus->response(j), p, z);
  }
}

// z and w of the effort that was found.
void Marcher::jump(StageState& state, double* z) {
  const int rows = program_.model->rows(), T = program_.width;
  for (int j = 0; j < state.effort[0].rows(); ++j) {
    const double* p = state.effort[0].row(j);
    if (std::none_of(p, p + T, [](double x) { return x != 0; })) continue;
    kernels_.add_column(rows, state.impulse->unknown(j), p, z);
    kernels_.add_column(rows, state.impulse->jump(j), p, state.w.data());
  }
  state.jumped = true;
}

// x_j += u_jw w, after the update of the slots.
void Marcher::add_jump(StageState& state) {
  for (std::size_t j = 0; j < state.update_w.size(); ++j) {
    if (state.update_w[j] == 0) continue;
    const double* terms[] = {slots_[j], state.w.data()};
    const double weights[] = {1.0, state.update_w[j]};
    kernels_.combine(static_cast<long>(state.w.size()), 2, terms, weights, slots_[j]);
  }
}

// What was p is p₋₁ now, and acts.
void Marcher::remember_efforts(const StageProgram& program, StageState& state, double* z) {
  for (std::size_t k = state.effort.size(); k-- > 1;)
    std::copy_n(state.effort[k - 1].data(), state.effort[0].size(), state.effort[k].data());
  const std::size_t size = static_cast<std::size_t>(lower_.rows()) * static_cast<std::size_t>(program_.width);
  for (std::size_t k = 1; k < program.effort.size() && k < state.effort_pointers.size(); ++k) {
    if (program.effort[k] == 0 || !state.effort_pointers[k]) continue;
    for (std::size_t e = 0; e < size; ++e) state.weighted.data()[e] = program.effort[k] * state.effort_pointers[k][e];
    find_pushed(state.weighted, lower_.rows(), pushing_);
    correct(state, state.weighted.data(), pushing_, z);
  }
}

// Of the lanes that are outside or were in contact, those that run and can be measured.
void Marcher::choose_touched(StageState& state, std::uint32_t mask) {
  touched_.clear();
  for (; mask != 0; mask &= mask - 1) {
    const int lane = std::countr_zero(mask);
    if (lane >= lanes() || !status_[static_cast<std::size_t>(lane)].running) continue;
    if (finite_in(state.free, lane)) {
      touched_.push_back(lane);
      state.touched_lanes |= 1u << lane;
    } else
      freeze(lane, {.cause = EndCause::position_not_finite});
  }
}

void Marcher::solve_law(const StageProgram& program, StageState& state, std::span<const int> touched) {
  for (const int lane : touched) outcome_[static_cast<std::size_t>(lane)] = {};
  ReducedProblem problem;
  problem.points = lower_.rows();
  problem.lanes = program_.width;
  problem.delassus = &columns_of(state);
  problem.reach = program.reach;
  problem.free = state.free.data();
  problem.lower = program.gate ? state.gate_lower.data() : law_lower().data();
  problem.upper = program.gate ? state.gate_upper.data() : law_upper().data();
  problem.rate_reach = program.rate_reach;
  problem.rate_free = state.rate.rows() > 0 ? state.rate.data() : nullptr;
  problem.before = state.before.rows() > 0 ? state.before.data() : nullptr;
  problem.memory = memory_.rows() > 0 ? memory_.data() : nullptr;
  problem.effort = state.effort[0].data();
  problem.touched = touched;
  problem.outcome = outcome_.data();
  circles_.solve(*program_.law, problem);
}

// Which lanes push now, and at which points; those that the law failed stop.
void Marcher::keep_contact(StageState& state) {
  const int points = state.effort[0].rows();
  state.contact_lanes = 0;
  std::fill(pushes_.begin(), pushes_.end(), false);
  for (const int lane : touched_) {
    if (!status_[static_cast<std::size_t>(lane)].running) continue;
    bool active = false, finite = true;
    for (int i = 0; i < points; ++i) {
      const double p = state.effort[0].at(i, lane);
      active |= p != 0;
      pushes_[static_cast<std::size_t>(i)] |= p != 0;
      finite &= p - p == 0;
    }
    const LaneOutcome& outcome = outcome_[static_cast<std::size_t>(lane)];
    if (!outcome.converged || !finite) {
      for (int i = 0; i < points; ++i) state.effort[0].at(i, lane) = 0;
      freeze(lane,
             finite
                 ? LaneEnd{.cause = EndCause::law_not_converged, .value = outcome.residual, .count = outcome.iterations}
                 : LaneEnd{.cause = EndCause::effort_not_finite});
      continue;
    }
    if (active) state.contact_lanes |= 1u << lane;
  }
  // Every effort of this stage is one of these lanes'.
  pushing_.clear();
  for (int i = 0; i < points; ++i)
    if (pushes_[static_cast<std::size_t>(i)]) pushing_.push_back(i);
}

// Stages that give back what contact took in a stage before them.

// δ = H s + Δφ of a stage that has found z. It is known up to round-off and what its law leaves of the measure. That is
// what the law says now, and a share of what it puts right at the beginning of the way.
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
  add_motions(program.motion_levels, false, state.way);
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
