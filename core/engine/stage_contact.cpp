#include <algorithm>
#include <bit>
#include <cmath>
#include <ricochet/algebra/box_problem.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/stage_state.hpp>

namespace ricochet {
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
  const std::uint32_t mask = measure_contact(program, state, z) | state.contact_lanes;
  if (mask == 0) return;
  choose_touched(state, mask);
  if (state.restored)
    restore_work(program, state);
  else
    solve_law(program, state);
  keep_contact(state);
  if (program_.tangents > 0) tangent_contact(program, state);
  if (state.impulse) {
    if (state.contact_lanes != 0) jump(state, z);
  } else if (program.effort[0] == 1.0) {
    if (state.contact_lanes != 0) correct(state, state.effort[0].data(), pushing_, z);
  } else if (program.effort[0] != 0 && state.contact_lanes != 0) {
    const auto size = state.effort[0].size();
    for (std::size_t e = 0; e < size; ++e) state.weighted.data()[e] = program.effort[0] * state.effort[0].data()[e];
    correct(state, state.weighted.data(), pushing_, z);
  }
  if (state.way.rows() > 0 && state.contact_lanes != 0) measure_way(program, state, z);
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
  for (int j = 0; j < lower_.rows(); ++j) {
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
  const auto size = state.effort[0].size();
  for (std::size_t k = state.effort.size(); k-- > 1;)
    std::copy_n(state.effort[k - 1].data(), size, state.effort[k].data());
  for (std::size_t k = 1; k < program.effort.size() && k < state.effort_pointers.size(); ++k) {
    if (program.effort[k] == 0 || !state.effort_pointers[k]) continue;
    for (std::size_t e = 0; e < size; ++e) state.weighted.data()[e] = program.effort[k] * state.effort_pointers[k][e];
    find_pushed(state.weighted, pushing_);
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

void Marcher::solve_law(const StageProgram& program, StageState& state) {
  for (const int lane : touched_) outcome_[static_cast<std::size_t>(lane)] = {};
  ReducedProblem problem;
  problem.points = lower_.rows();
  problem.lanes = program_.width;
  problem.delassus = state.delassus.get();
  if (state.impulse) problem.delassus = state.impulse.get();
  problem.reach = program.reach;
  problem.free = state.free.data();
  problem.lower = program.gate ? state.gate_lower.data() : lower_.data();
  problem.upper = program.gate ? state.gate_upper.data() : upper_.data();
  problem.rate_reach = program.rate_reach;
  problem.rate_free = state.rate.rows() > 0 ? state.rate.data() : nullptr;
  problem.before = state.before.rows() > 0 ? state.before.data() : nullptr;
  problem.memory = memory_.rows() > 0 ? memory_.data() : nullptr;
  problem.effort = state.effort[0].data();
  problem.touched = touched_;
  problem.outcome = outcome_.data();
  program_.law->solve(problem);
}

// Which lanes push now, and at which points; those that the law failed stop.
void Marcher::keep_contact(StageState& state) {
  const int points = lower_.rows();
  state.contact_lanes = 0;
  std::fill(pushes_.begin(), pushes_.end(), false);
  for (const int lane : touched_) {
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

}  // namespace ricochet
