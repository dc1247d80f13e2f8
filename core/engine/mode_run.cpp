#include <algorithm>
#include <bit>
#include <ricochet/engine/march_loads.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/mode_run.hpp>
#include <ricochet/engine/stage_state.hpp>

/// \file
/// Steps of modes that nobody looks at, many in one call of a kernel: plans of one stage, one contact point whose law
/// reads a position. Results are bitwise those of steps made one by one.
namespace ricochet {

bool Marcher::may_run() const {
  if (program_.flight || program_.load || program_.friction || stage_states_.size() != 1) return false;
  const StageState& state = *stage_states_.front();
  const StageProgram& program = program_.stages.front();
  return state.test && state.increments && !state.impulse && program.op->modes() && program.effort[0] == 1.0 &&
         state.way.rows() == 0;
}

void Marcher::prepare_run() {
  if (!may_run()) return;
  run_ = std::make_unique<ModeRunBlocks>(program_.model->rows(), program_.width);
  ModeRun& kernel = run_->kernel;
  kernel.modes = *program_.stages.front().op->modes();
  kernel.x[0] = slots_[0];
  kernel.x[1] = slots_[1];
  kernel.scale = run_->scale.data();
  kernel.offset = run_->offset.data();
  kernel.lower = lower_.data();
  kernel.upper = upper_.data();
  kernel.y = stage_states_.front()->free.data();
}

// What drives the step under way and those to come.
void Marcher::drive_run(int steps) {
  if (!program_.support) return;
  const StageProgram& program = program_.stages.front();
  for (int s = 0; s <= steps; ++s) {
    clamp_.set_step(step_ + s, program_.h);
    clamp_.accelerations(program.load_phase, run_->scale.row(s));
    clamp_.offsets(program.measure_phase, run_->offset.row(s), false);
  }
}

// Efforts of the step under way. Whether all lanes that were looked at go on.
bool Marcher::push_in_run() {
  StageState& state = *stage_states_.front();
  choose_touched(state, run_->kernel.outside | state.contact_lanes);
  solve_law(program_.stages.front(), state, touched_);
  keep_contact(state);
  run_->kernel.effort = state.contact_lanes != 0 ? state.effort[0].data() : nullptr;
  if (run_->kernel.effort && !run_->kernel.column) {
    std::copy_n(state.delassus->response(0), program_.model->rows(), run_->column.data());
    run_->kernel.column = run_->column.data();
  }
  return frozen_now_ == 0;
}

// Up to so many steps. It ends before one that has to be made by itself.
long long Marcher::run(long long most) {
  StageState& state = *stage_states_.front();
  ModeRun& kernel = run_->kernel;
  const bool watched = !observers_.empty(), pushes = !watched && program_.tangents == 0;
  if (frozen_now_ != 0 || (!pushes && state.contact_lanes != 0)) return 0;
  long long made = 0;
  bool measured = false, sound = true;
  int driven = -1, first = 0;  // steps that are driven, from that many before this one on
  while (sound && made < most) {
    const long long to_check = check_interval - step_ % check_interval;
    long long count = std::min(most - made, to_check);
    if (watched) count = std::min(count, observers_.next_shown() - 1 - step_);
    if (count <= 0) break;
    if (first + count > driven) {
      driven = static_cast<int>(count);
      first = 0;
      drive_run(driven);
    }
    kernel.scale = run_->scale.row(first);
    kernel.offset = run_->offset.row(first);
    if (!measured) {
      kernel.steps = 0;
      kernels_.mode_run(kernel);
      measured = true;
    }
    kernel.effort = nullptr;
    kernel.steps = static_cast<int>(count);
    const bool pushed = (kernel.outside | state.contact_lanes) != 0;
    if (pushed) {
      if (!pushes) break;
      remember_efforts(program_.stages.front(), state, nullptr);
      sound = push_in_run();
      if (!sound || state.contact_lanes != 0) kernel.steps = 1;
    }
    const int done = kernels_.mode_run(kernel);
    // What was p is p₋₁, p₋₂, …
    for (int k = pushed ? 1 : 0; k < std::min(done, static_cast<int>(state.effort.size())); ++k)
      remember_efforts(program_.stages.front(), state, nullptr);
    state.touched_lanes = pushed && done == 1 ? state.touched_lanes : 0;
    if (watched) {
      for (int s = 0; s < done; ++s) {
        clamp_.set_step(step_ + s, program_.h);
        free_steps_[free_count_++] = {clamp_.sine(), clamp_.cosine(), 0, 0, 0};
      }
    }
    made += done;
    first += done;
    step_ += done;
    visited_ += done;
    if (step_ % check_interval == 0) {
      tell_free_steps();
      check_lanes();
      sound = sound && frozen_now_ == 0;
    }
  }
  // The unknown of a lane that froze was whatever stopped it.
  for (; frozen_now_ != 0; frozen_now_ &= frozen_now_ - 1) clear_lane(std::countr_zero(frozen_now_));
  return made;
}

}  // namespace ricochet
