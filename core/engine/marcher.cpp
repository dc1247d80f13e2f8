#include <algorithm>
#include <bit>
#include <ricochet/engine/energy_bounds.hpp>
#include <ricochet/engine/flight/lane_flight.hpp>
#include <ricochet/engine/march_loads.hpp>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/engine/mode_run.hpp>
#include <ricochet/engine/stage_friction.hpp>
#include <ricochet/engine/stage_state.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <utility>

namespace ricochet {

static_assert(most_slots <= most_lane_slots);

Marcher::~Marcher() = default;
Marcher::Marcher(Marcher&&) noexcept = default;

Marcher::Marcher(Program program)
    : program_(std::move(program)),
      kernels_(lane_kernels(program_.width)),
      clamp_(program_.problem->support.pulsation, program_.width) {
  const MarchModel& model = *program_.model;
  const int rows = model.rows(), T = program_.width, points = program_.problem->points();
  const auto slot_count = program_.plan.slots.size();
  if (program_.kind != OperatorKind::sparse) {
    stiffness_width_ = half_bandwidth(model.stiffness());
    if (!model.inertia().factored())
      stiffness_width_ = std::max(stiffness_width_, half_bandwidth(model.inertia().mass));
    stiffness_band_ = band_storage(model.stiffness(), stiffness_width_, T == 1);
  }
  blocks_.reserve(slot_count);
  // A step by nodes reads three rows before the first, however narrow K is.
  const int border = std::max(stiffness_width_, 3);
  for (std::size_t j = 0; j < slot_count; ++j) blocks_.emplace_back(rows, T, border);
  for (Block& block : blocks_) slots_.push_back(block.data());
  slot_pointers_.assign(slots_.begin(), slots_.end());
  combination_ = Block(rows, T, border);
  elastic_ = Block(rows, T);
  scale_ = Block(1, T);
  offset_ = Block(1, T);
  outcome_.resize(static_cast<std::size_t>(T));
  status_.resize(program_.lanes.size());
  touched_.reserve(static_cast<std::size_t>(T));
  if (program_.friction) rubbing_ = std::make_unique<StageFriction>(program_);
  const int pushed = points + (program_.friction ? model.rubbed().rows() : 0);
  pushed_.reserve(static_cast<std::size_t>(points));
  pushing_.reserve(static_cast<std::size_t>(pushed));
  pushes_.resize(static_cast<std::size_t>(pushed));
  scratch_.resize(static_cast<std::size_t>(rows + points));
  if (program_.contact) {
    lower_ = Block(points, T);
    upper_ = Block(points, T);
    lower_.fill(-infinity);
    upper_.fill(infinity);
  }
  energy_bounds_ = std::make_unique<EnergyBounds>(program_);
  prepare_law();
  for (int lane = 0; lane < lanes(); ++lane) {
    const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
    const Eigen::VectorXd q = model.to_model(spec.position), v = model.to_model(spec.velocity);
    for (std::size_t j = 0; j < slot_count; ++j)
      for (int i = 0; i < rows; ++i)
        blocks_[j].at(i, lane) = program_.plan.initial[j][0] * q[i] + program_.plan.initial[j][1] * v[i];
    place_lane(lane);
  }
  if (program_.flight) lane_flight_ = std::make_unique<LaneFlight>();
  if (program_.load) load_window_ = std::make_unique<LoadWindow>(program_);
  for (std::size_t k = 0; k < program_.start.size(); ++k)
    start_states_.push_back(make_state(program_.start[k], program_.plan.start[k]));
  for (std::size_t k = 0; k < program_.stages.size(); ++k)
    stage_states_.push_back(make_state(program_.stages[k], program_.plan.stages[k]));
  for (std::size_t k = 0; k < start_states_.size(); ++k) start_states_[k]->view = view_of(true, k, *start_states_[k]);
  for (std::size_t k = 0; k < stage_states_.size(); ++k) stage_states_[k]->view = view_of(false, k, *stage_states_[k]);
  connect_efforts();
  connect_works();
  connect_tests();
  prepare_run();
}

// What the integration does for its observers alone. Operators add up squares of unknowns that only efforts of the same
// stage may move.
void Marcher::connect(const Observers& observers) {
  observers_ = observers;
  free_count_ = 0;
  tells_tip_ = false;
  const StepObserver* asks = nullptr;
  int asking = 0;
  for (const StepObserver* one : observers_) {
    tells_tip_ = tells_tip_ || one->asks().tip;
    if (one->asks().squares.empty()) continue;
    if (!asks) asks = one;
    ++asking;
  }
  for (std::size_t k = 0; k < stage_states_.size(); ++k) {
    const StageProgram& program = program_.stages[k];
    SquareSum*& sum = stage_states_[k]->sum;
    const bool known = program.op && program.driven && program.effort.size() == 1 && !program_.load;
    sum = asks && known && program.op->sums_squares() ? asks->asks().squares[k] : nullptr;
    if (sum) sum->x = slots_[1];
  }
  const bool told_alone = asking > 0 || tells_tip_;  // of the one lane that there is
  keeps_sums_ = !observers_.empty() && asking < 2 && (program_.width == 1 || !told_alone) &&
                stage_states_.size() == 1 && !program_.flight;
  runs_ = run_ && (observers_.empty() || (keeps_sums_ && !told_alone));
}

namespace {

// The weights of a combination over the slots and z, as the kernels read them.
std::vector<double> with_z(Combination c, std::size_t slots) {
  c.slots.resize(slots, 0.0);
  c.slots.push_back(c.z);
  return c.slots;
}

// Storage of a gate, and of the rebound of each point.
void make_gate(StageState& state, const VelocityGate& gate, const SemiDiscrete& problem, std::size_t slots, int width) {
  const int points = problem.points();
  for (Block* block : {&state.gap, &state.approach, &state.gate_lower, &state.gate_upper})
    *block = Block(points, width);
  state.fastest = Block(1, width);
  state.rebound.assign(static_cast<std::size_t>(points), gate.restitution);
  for (std::size_t i = 0; i < problem.own.size(); ++i)
    state.rebound[i] = problem.own[i].restitution.value_or(gate.restitution);
  state.gap_weights = with_z(gate.predictor, slots);
  state.approach_weights = with_z(gate.approach, slots);
}

}  // namespace

// Storage of a stage, and its combinations as the kernels read them.
std::unique_ptr<StageState> Marcher::make_state(StageProgram& stage, const Stage& plan) const {
  const MarchModel& model = *program_.model;
  const int T = program_.width, points = program_.problem->points();
  const auto slots = program_.plan.slots.size();
  auto state = std::make_unique<StageState>();
  for (const Combination& c : plan.update) {
    const std::vector<double> row = with_z(c, slots);
    state->update.insert(state->update.end(), row.begin(), row.end());
    state->update_w.push_back(c.w);
  }
  state->increments = state->update == std::vector<double>{1, 1, 1, 0, 1, 1};
  if (!program_.contact || !stage.reads_contact) return state;
  const bool product = model.inertia().inverted() && stage.folded.stiffness == 0;
  const bool band = (program_.kind == OperatorKind::band || program_.kind == OperatorKind::diagonal) && !product;
  state->delassus = std::make_unique<StageDelassus>(*stage.op, model, band ? &stage.folded : nullptr);
  if (stage.impulse.op) {
    state->impulse = std::make_unique<StageImpulse>(stage.impulse, *stage.op, model);
    state->w = Block(model.rows(), T);
  }
  const int pushed = points + (program_.friction ? model.rubbed().rows() : 0);
  state->effort.emplace_back(pushed, T);
  state->free = Block(points, T);
  if (stage.effort.size() > 1 || stage.effort[0] != 1.0 || (program_.friction && stage.friction_weight != 1.0))
    state->weighted = Block(pushed, T);
  if (program_.friction) {
    state->end_rate = Block(model.rubbed().rows(), T);
    state->end_rate_weights = with_z(stage.facts.end_rate.rate, slots);
    for (std::size_t j = 0; j < state->end_rate_weights.size(); ++j)
      if (state->end_rate_weights[j] != 0) state->end_rate_of.push_back(j);
    state->columns.resize(static_cast<std::size_t>(lower_.rows() + program_.model->rubbed().rows()));
    state->couples.resize(static_cast<std::size_t>(program_.model->rubbed().rows()));
    std::erase(state->end_rate_weights, 0.0);
  }
  state->measure_weights = with_z(stage.measure, slots);
  if (program_.tangents > 0) state->tangents.reserve(points);
  if (stage.compliance && program_.law->reads_rate()) {
    state->rate = Block(points, T);
    state->rate_weights = with_z(stage.compliance->rate, slots);
  }
  if (stage.compliance && stage.compliance->before) {
    state->before = Block(points, T);
    state->before_weights = with_z(*stage.compliance->before, slots);
  }
  if (stage.gate) make_gate(*state, *stage.gate, *program_.problem, slots, T);
  if (!stage.motion.slots.empty()) {
    state->way = Block(points, T);
    state->way_error = Block(1, T);
    state->way_weights = with_z(stage.motion, slots);
  }
  if (stage.restores > 0) state->restoring.prepare(points);
  if (program_.eager_delassus)
    for (int j = 0; j < points; ++j) state->impulse ? state->impulse->column(j) : state->delassus->column(j);
  return state;
}

void Marcher::start(const Observers& observers) {
  const FlushDenormals flush;
  observers_ = observers;
  clamp_.set_time(time());
  begin_contact();
  for (std::size_t k = 0; k < program_.start.size(); ++k)
    run_stage(program_.start[k], program_.plan.start[k], *start_states_[k], static_cast<int>(k), false, false);
  keep_start_efforts();
  if (program_.plan.start_advances) {
    ++step_;
    for (StepObserver* one : observers_) one->step_done(*this);
  }
  check_lanes();
}

long long Marcher::march(long long steps, const Observers& observers) {
  const FlushDenormals flush;
  connect(observers);
  const bool observed = !observers_.empty();
  long long next_shown = keeps_sums_ ? observers_.next_shown() : 0;
  for (long long n = 0; n < steps; ++n) {
    if (lane_flight_) n += fly(steps - n - 1);
    if (runs_) {
      n += run(steps - n);
      if (n == steps || (step_ % check_interval == 0 && !any_running())) {
        tell_free_steps();
        return n;
      }
    }
    if (program_.support) clamp_.set_step(step_, program_.h);
    // Whether nobody looks at the slots between this step and the next, and whether no observer need see it.
    const bool unchecked = (step_ + 1) % check_interval != 0, unseen = unchecked && step_ + 1 < next_shown;
    const bool goes_on = (!observed || unseen) && !program_.flight && !runs_ && n + 1 < steps && unchecked;
    bool shown = observed;
    if (memory_before_.rows() > 0) std::copy_n(memory_.data(), memory_.size(), memory_before_.data());
    for (std::size_t k = 0; k < program_.stages.size(); ++k)
      shown = run_stage(program_.stages[k], program_.plan.stages[k], *stage_states_[k], static_cast<int>(k), unseen,
                        goes_on);
    ++step_;
    ++visited_;
    if (lane_flight_) lane_flight_->step_made();
    if (shown) {
      // Observers ask where the clamp is now; the next step begins here.
      if (program_.support) clamp_.set_step(step_, program_.h);
      for (StepObserver* one : observers_) one->step_done(*this);
      if (keeps_sums_) next_shown = observers_.next_shown();
    }
    if (step_ % check_interval == 0) {
      check_lanes();
      if (!any_running()) return n + 1;
    }
  }
  tell_free_steps();
  return steps;
}

// Leaves out steps in which contact stays what it is, before the next one; returns how many.
long long Marcher::fly(long long most) {
  // Delayed tangents count the steps of an impact.
  if (delay_steps_ > 0) return 0;
  const FlownLane lane{program_, stage_states_, slots_, memory_};
  if (!lane_flight_->follow(lane) || most < Flight::least || !status_.front().running) return 0;
  most = std::min(most, observers_.next_shown() - 1 - step_);
  if (!lane_flight_->due(lane, most)) return 0;
  double e[3] = {0, 0, 0};
  if (program_.support) {
    clamp_.set_time(time());
    clamp_.drive(0, e[0], e[1]);
    e[2] = 1;
  } else if (const double pulsation = program_.load_pulsation; pulsation > 0) {
    e[0] = std::sin(pulsation * time());
    e[1] = std::cos(pulsation * time());
    e[2] = 1;
  } else {
    e[0] = 1;
  }
  StepInterval told;
  told.from = time();
  const long long k = lane_flight_->leave_out(lane, e, most, !observers_.empty(), told);
  if (k == 0) return 0;
  step_ += k;
  combined_for_ = nullptr;
  check_lanes();
  for (StepObserver* one : observers_) one->interval(*this, told);
  return k;
}

// Keeps what is told of a step that is not shown. The tip stands where the step before it ended.
void Marcher::keep_free_step(const StageState& state) {
  if (tells_tip_ && free_count_ > 0) free_steps_[free_count_ - 1].tip = tip(0);
  free_steps_[free_count_++] = {clamp_.sine(), clamp_.cosine(), state.sum ? state.sum->form : 0,
                                state.sum ? state.sum->projection : 0, 0};
}

void Marcher::tell_free_steps() {
  if (free_count_ == 0) return;
  if (tells_tip_) free_steps_[free_count_ - 1].tip = tip(0);
  StepInterval told;
  told.steps = static_cast<long long>(free_count_);
  told.from = static_cast<double>(step_ - told.steps) * program_.h;
  told.marched = {free_steps_.data(), free_count_};
  free_count_ = 0;
  for (StepObserver* one : observers_) one->interval(*this, told);
}

void Marcher::combine_for(const StageProgram& program) {
  if (combined_for_ == &program) return;
  kernels_.combine(static_cast<long>(combination_.size()), slot_count(), slot_pointers_.data(),
                   program.folded.stiffness_history.data(), combination_.data());
  combined_for_ = &program;
}

// z° = S⁻¹ b.
void Marcher::free_step(StageProgram& program, const Stage& plan, StageState& state) {
  if (!program.driven) {
    std::fill_n(program.op->unknown(), program_.model->rows() * program_.width, 0.0);
    return;
  }
  FreeStepInput input;
  input.slots = slot_pointers_.data();
  IncrementUpdate update;
  if (waiting_) {
    const std::vector<double>& next = program.folded.stiffness_history;
    update = {slots_.data(), waiting_, {next[0], next[1]}};
    input.update = &update;
    waiting_ = nullptr;
    combined_for_ = nullptr;
  } else if (program.op->keeps_combination()) {
    combine_for(program);
    input.k = combination_.data();
  }
  if (program_.support) {
    clamp_.accelerations(program.load_phase, scale_.data());
    input.scale = scale_.data();
  }
  if (state.test) {
    if (program_.support) clamp_.offsets(program.measure_phase, offset_.data(), false);
    input.test = &*state.test;
  }
  input.sum = state.sum;
  input.load = distributed_load(plan.load, time());
  program.op->free_step(input);
  if (program_.tangents > 0 && input.load) remove_load(program, input.load);
}

// Whether the stage was shown to observers.
bool Marcher::run_stage(StageProgram& program, const Stage& plan, StageState& state, int index, bool unseen,
                        bool may_wait) {
  const double* z = elastic_.data();
  if (program.op) {
    free_step(program, plan, state);
    if (state.delassus) contact(program, state, program.op->unknown());
    z = program.op->unknown();
  } else {
    // Nothing to solve: z = 0.
    elastic_.fill(0.0);
  }
  const bool observed = !observers_.empty();
  const bool shown = observed && !(unseen && (state.touched_lanes | state.contact_lanes | frozen_now_) == 0);
  if (shown)
    show(state, z);
  else if (observed)
    keep_free_step(state);
  // A jump comes after the update: what the next stage multiplies is combined anew.
  const StageProgram* next = nullptr;
  const bool last = index + 1 == static_cast<int>(program_.stages.size());
  const StageProgram& following = program_.stages[last ? 0 : static_cast<std::size_t>(index) + 1];
  if (!state.jumped && following.op && following.driven && following.op->keeps_combination() &&
      &program >= program_.stages.data() && &program < program_.stages.data() + program_.stages.size())
    next = &following;
  if (may_wait && !shown && state.increments && !state.jumped && frozen_now_ == 0 && following.op && following.driven &&
      following.op->takes_update() && !program_.load) {
    waiting_ = z;
    return shown;
  }
  kernels_.update(static_cast<long>(combination_.size()), slot_count(), slots_.data(), z, state.update.data(),
                  next ? next->folded.stiffness_history.data() : nullptr, combination_.data());
  combined_for_ = next;
  if (state.jumped) add_jump(state);
  // The unknown of a lane that froze during this stage was whatever stopped it.
  for (; frozen_now_ != 0; frozen_now_ &= frozen_now_ - 1) clear_lane(std::countr_zero(frozen_now_));
  return shown;
}

// The points with an effort, in any lane.
void Marcher::find_pushed(const Block& effort, int rows, std::vector<int>& points) {
  points.clear();
  const int T = effort.lanes();
  if (T == 1) {
    const double* p = effort.data();
    for (int i = 0; i < rows; ++i)
      if (p[i] != 0) points.push_back(i);
    return;
  }
  for (int i = 0; i < rows; ++i) {
    const double* p = effort.row(i);
    if (std::any_of(p, p + T, [](double x) { return x != 0; })) points.push_back(i);
  }
}

// What stays the same from step to step of what observers see of a stage.
StageView Marcher::view_of(bool starting, std::size_t index, const StageState& state) const {
  StageView view;
  view.stage = static_cast<int>(index);
  view.starting = starting;
  view.plan = &(starting ? program_.plan.start : program_.plan.stages)[index];
  view.program = &(starting ? program_.start : program_.stages)[index];
  view.slots = slot_pointers_.data();
  if (!state.delassus) return view;
  view.outcome = outcome_.data();
  if (rubbing_) view.friction = rubbing_.get();
  view.free = state.free.data();
  return view;
}

// What observers see of a stage that has found z and p.
void Marcher::show(StageState& state, const double* z) {
  tell_free_steps();
  StageView& view = state.view;
  const StageFacts& facts = view.program->facts;
  view.time = time();
  view.from = view.time + facts.from * program_.h;
  view.to = view.time + facts.to * program_.h;
  view.z = z;
  view.w = state.jumped ? state.w.data() : nullptr;
  view.sum = state.contact_lanes == 0 ? state.sum : nullptr;
  if (state.delassus) {
    view.effort = state.effort_pointers.data();
    view.efforts = static_cast<int>(state.effort_pointers.size());
    view.touched_lanes = state.touched_lanes;
    view.contact_lanes = state.contact_lanes;
    pushed_.clear();
    if (state.contact_lanes != 0) find_pushed(state.effort[0], lower_.rows(), pushed_);
    view.pushed = pushed_;
  }
  for (StepObserver* one : observers_) one->stage_solved(*this, view);
}

}  // namespace ricochet
