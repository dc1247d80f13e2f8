#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <ricochet/algebra/band_ldlt.hpp>
#include <ricochet/algebra/flush_denormals.hpp>
#include <ricochet/engine/energy_scale.hpp>
#include <ricochet/engine/marcher_state.hpp>
#include <set>
#include <utility>

namespace ricochet {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

static_assert(most_slots <= most_lane_slots);

// Lanes are looked at this often when nobody observes them; the cause says so.
constexpr long long check_interval = 16;

// Energy beyond this multiple of the scene's own scale counts as divergence.
constexpr double divergence_factor = 1e9;

// Times of a step at which the load is asked, of stages and of their work forms.
std::size_t distinct_load_levels(const StepPlan& plan) {
  std::set<long long> levels;
  const auto add = [&](const Levels& list) {
    for (const Level& level : list) levels.insert(std::llround(level.at * 1e6));
  };
  for (const auto* stages : {&plan.start, &plan.stages})
    for (const Stage& stage : *stages) {
      add(stage.load);
      if (stage.work) add(stage.work->load);
    }
  return levels.size();
}

// Stage `place` counted from the first of a step, negative in the steps before: which one it is, and how many steps
// ago.
std::pair<std::ptrdiff_t, std::ptrdiff_t> place_in_steps(std::ptrdiff_t place, std::ptrdiff_t stages) {
  const std::ptrdiff_t steps = place >= 0 ? 0 : (stages - 1 - place) / stages;
  return {place + steps * stages, steps};
}

}  // namespace

Marcher::~Marcher() = default;
Marcher::Marcher(Marcher&&) noexcept = default;

Marcher::Marcher(Program program) : program_(std::move(program)), kernels_(lane_kernels(program_.width)) {
  const MarchModel& model = *program_.model;
  const SemiDiscrete& problem = *program_.problem;
  const int rows = model.rows(), T = program_.width, points = problem.points();
  const auto slot_count = program_.plan.slots.size();
  stiffness_width_ = half_bandwidth(model.stiffness());
  if (!model.inertia().factored()) stiffness_width_ = std::max(stiffness_width_, half_bandwidth(model.inertia().mass));
  stiffness_rows_ = band_storage(model.stiffness(), stiffness_width_, T == 1);
  blocks_.reserve(slot_count);
  for (std::size_t j = 0; j < slot_count; ++j) blocks_.emplace_back(rows, T, stiffness_width_);
  for (Block& block : blocks_) slots_.push_back(block.data());
  slot_pointers_.assign(slots_.begin(), slots_.end());
  combination_ = Block(rows, T, stiffness_width_);
  elastic_ = Block(rows, T);
  scale_ = Block(1, T);
  offset_ = Block(1, T);
  amplitude_ = Block(1, T);
  cos_phase_ = Block(1, T);
  sin_phase_ = Block(1, T);
  outcome_.resize(static_cast<std::size_t>(T));
  status_.resize(program_.lanes.size());
  touched_.reserve(static_cast<std::size_t>(T));
  scratch_.resize(static_cast<std::size_t>(std::max(rows, points)));
  if (program_.contact) {
    lower_ = Block(points, T);
    upper_ = Block(points, T);
    lower_.fill(-infinity);
    upper_.fill(infinity);
  }
  energy_scale_ = std::make_unique<EnergyScale>(problem);
  lane_bounds_.resize(program_.lanes.size());
  if (program_.load) load_bound_ = divergence_factor * energy_scale_->of_load(0);
  for (int lane = 0; lane < lanes(); ++lane) {
    const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
    const Eigen::VectorXd q = model.to_model(spec.position), v = model.to_model(spec.velocity);
    for (std::size_t j = 0; j < slot_count; ++j)
      for (int i = 0; i < rows; ++i)
        blocks_[j].at(i, lane) = program_.plan.initial[j][0] * q[i] + program_.plan.initial[j][1] * v[i];
    place_lane(lane);
  }
  if (program_.load) {
    load_window_ = std::make_unique<LoadWindow>();
    load_window_->entries.resize(distinct_load_levels(program_.plan) + 1);
    for (auto& entry : load_window_->entries) entry.value.resize(static_cast<std::size_t>(rows));
    load_window_->sum.resize(static_cast<std::size_t>(rows));
    load_window_->nodal.resize(static_cast<std::size_t>(rows));
  }
  prepare_law();
  const auto with_z = [&](Combination c) {
    c.slots.resize(slot_count, 0.0);
    c.slots.push_back(c.z);
    return c.slots;
  };
  const auto make_state = [&](StageProgram& stage, const Stage& plan) {
    auto state = std::make_unique<StageState>();
    for (const Combination& c : plan.update) {
      const std::vector<double> row = with_z(c);
      state->update.insert(state->update.end(), row.begin(), row.end());
    }
    if (!program_.contact || !stage.reads_contact) return state;
    state->delassus = std::make_unique<StageDelassus>(*stage.op, model.contact(), rows);
    state->effort.emplace_back(points, T);
    state->free = Block(points, T);
    if (stage.effort.size() > 1 || stage.effort[0] != 1.0) state->weighted = Block(points, T);
    state->measure_weights = with_z(stage.measure);
    if (program_.tangents > 0) state->tangents.reserve(points);
    if (stage.compliance && program_.law->reads_rate()) {
      state->rate = Block(points, T);
      state->rate_weights = with_z(stage.compliance->rate);
    }
    if (stage.compliance && stage.compliance->before) {
      state->before = Block(points, T);
      state->before_weights = with_z(*stage.compliance->before);
    }
    if (stage.gate) {
      state->gap = Block(points, T);
      state->approach = Block(points, T);
      state->fastest = Block(1, T);
      state->gate_lower = Block(points, T);
      state->gate_upper = Block(points, T);
      state->gap_weights = with_z(stage.gate->predictor);
      state->approach_weights = with_z(stage.gate->approach);
    }
    if (program_.eager_delassus)
      for (int j = 0; j < points; ++j) state->delassus->column(j);
    return state;
  };
  for (std::size_t k = 0; k < program_.start.size(); ++k)
    start_states_.push_back(make_state(program_.start[k], program_.plan.start[k]));
  for (std::size_t k = 0; k < program_.stages.size(); ++k)
    stage_states_.push_back(make_state(program_.stages[k], program_.plan.stages[k]));
  connect_efforts();
}

// Which block holds p₋ₖ of each stage: stages follow each other without end, and each keeps as many of its own efforts
// as any stage looks back to.
void Marcher::connect_efforts() {
  const auto stages = static_cast<std::ptrdiff_t>(stage_states_.size());
  const auto weights = [&](std::ptrdiff_t i) {
    const StageProgram& stage = program_.stages[static_cast<std::size_t>(i)];
    return static_cast<std::ptrdiff_t>(std::max(stage.effort.size(), stage.work_effort.size()));
  };
  struct Source {
    StageState* stage;
    std::size_t ago;
  };
  const auto source = [&](std::ptrdiff_t i, std::ptrdiff_t k) {
    const auto [j, steps] = place_in_steps(i - k, stages);
    // A stage that comes later in the step holds its effort of the step before.
    return Source{stage_states_[static_cast<std::size_t>(j)].get(),
                  static_cast<std::size_t>(j > i ? steps - 1 : steps)};
  };
  for (std::ptrdiff_t i = 0; i < stages; ++i) {
    if (!stage_states_[static_cast<std::size_t>(i)]->delassus) continue;
    for (std::ptrdiff_t k = 1; k < weights(i); ++k) {
      const auto [stage, ago] = source(i, k);
      if (!stage->delassus) continue;
      while (stage->effort.size() <= ago) stage->effort.emplace_back(lower_.rows(), program_.width);
    }
  }
  for (std::ptrdiff_t i = 0; i < stages; ++i) {
    StageState& state = *stage_states_[static_cast<std::size_t>(i)];
    if (!state.delassus) continue;
    for (std::ptrdiff_t k = 0; k < weights(i); ++k) {
      const auto [stage, ago] = source(i, k);
      state.effort_pointers.push_back(stage->delassus ? stage->effort[ago].data() : nullptr);
    }
  }
  // Before the start rule there was nothing.
  for (std::size_t i = 0; i < start_states_.size(); ++i) {
    StageState& state = *start_states_[i];
    if (!state.delassus) continue;
    const std::size_t most = std::max(program_.start[i].effort.size(), program_.start[i].work_effort.size());
    for (std::size_t k = 0; k <= i && k < most; ++k) {
      const StageState& before = *start_states_[i - k];
      state.effort_pointers.push_back(before.delassus ? before.effort[0].data() : nullptr);
    }
  }
}

// The stages of the start rule stand where the last ones of the steps before the first would.
void Marcher::keep_start_efforts() {
  const auto before = static_cast<std::ptrdiff_t>(start_states_.size());
  for (std::ptrdiff_t i = 0; i < before; ++i) {
    const auto [j, steps] = place_in_steps(i - before, static_cast<std::ptrdiff_t>(stage_states_.size()));
    const auto ago = static_cast<std::size_t>(steps - 1);
    StageState &start = *start_states_[static_cast<std::size_t>(i)],
               &stage = *stage_states_[static_cast<std::size_t>(j)];
    if (!start.delassus || !stage.delassus || ago >= stage.effort.size()) continue;
    std::copy_n(start.effort[0].data(), start.effort[0].size(), stage.effort[ago].data());
    if (ago == 0) stage.contact_lanes = start.contact_lanes;
  }
}

bool Marcher::any_running() const {
  return std::any_of(status_.begin(), status_.end(), [](const LaneStatus& status) { return status.running; });
}

double Marcher::support(int lane, double t) const {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  return spec.amplitude * std::sin(program_.problem->support.pulsation * t + spec.phase);
}

double Marcher::support_rate(int lane, double t) const {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  const double omega = program_.problem->support.pulsation;
  return spec.amplitude * omega * std::cos(omega * t + spec.phase);
}

double Marcher::support_levels(int lane, double t, const Levels& levels) const {
  double sum = 0;
  for (const Level& level : levels) sum += level.weight * support(lane, t + level.at * program_.h);
  return sum;
}

// Σ_k w_k A sin(ω(t+c_k h)+ψ), or its rate, for every lane: two numbers per step, whatever the number of lanes.
void Marcher::support_offsets(const PhaseWeights& phase, double* out, bool rate) const {
  const double omega = program_.problem->support.pulsation;
  double s = sine_ * phase.along + cosine_ * phase.across, c = cosine_ * phase.along - sine_ * phase.across;
  if (rate) {
    std::swap(s, c);
    s *= omega;
    c *= -omega;
  }
  for (int lane = 0; lane < program_.width; ++lane)
    out[lane] = amplitude_.at(0, lane) * (phases_ ? s * cos_phase_.at(0, lane) + c * sin_phase_.at(0, lane) : s);
}

const double* Marcher::distributed_load(const Levels& levels, double t) {
  if (!program_.load) return nullptr;
  LoadWindow& window = *load_window_;
  std::fill(window.sum.begin(), window.sum.end(), 0.0);
  for (const Level& level : levels) {
    const double key = program_.load_constant ? 0.0 : t / program_.h + level.at;
    auto found = std::find_if(window.entries.begin(), window.entries.end(),
                              [&](const auto& entry) { return std::abs(entry.level - key) < 1e-6; });
    if (found == window.entries.end()) {
      found = std::min_element(window.entries.begin(), window.entries.end(),
                               [](const auto& a, const auto& b) { return a.used < b.used; });
      found->level = key;
      program_.problem->load->assemble(t + level.at * program_.h, window.nodal.data());
      program_.model->load_to_model(window.nodal.data(), found->value.data());
    }
    found->used = ++window.clock;
    for (std::size_t i = 0; i < window.sum.size(); ++i) window.sum[i] += level.weight * found->value[i];
  }
  return window.sum.data();
}

void Marcher::start(StepObserver* observer) {
  const FlushDenormals flush;
  const double omega = program_.problem->support.pulsation;
  sine_ = std::sin(omega * time());
  cosine_ = std::cos(omega * time());
  for (std::size_t k = 0; k < program_.start.size(); ++k)
    run_stage(program_.start[k], program_.plan.start[k], *start_states_[k], static_cast<int>(k), observer);
  keep_start_efforts();
  if (program_.plan.start_advances) {
    ++step_;
    if (observer) observer->step_done(*this);
  }
  check_lanes();
}

long long Marcher::march(long long steps, StepObserver* observer) {
  const FlushDenormals flush;
  const double omega = program_.problem->support.pulsation;
  for (long long n = 0; n < steps; ++n) {
    if (program_.support) {
      sine_ = std::sin(omega * time());
      cosine_ = std::cos(omega * time());
    }
    for (std::size_t k = 0; k < program_.stages.size(); ++k)
      run_stage(program_.stages[k], program_.plan.stages[k], *stage_states_[k], static_cast<int>(k), observer);
    ++step_;
    if (observer) observer->step_done(*this);
    if (step_ % check_interval == 0) {
      check_lanes();
      if (!any_running()) return n + 1;
    }
  }
  return steps;
}

void Marcher::combine_for(const StageProgram& program) {
  if (combined_for_ == &program) return;
  kernels_.combine(static_cast<long>(combination_.size()), slot_count(), slot_pointers_.data(),
                   program.folded.stiffness_history.data(), combination_.data());
  combined_for_ = &program;
}

void Marcher::run_stage(StageProgram& program, const Stage& plan, StageState& state, int index,
                        StepObserver* observer) {
  const double* z = elastic_.data();
  if (program.op) {
    FreeStepInput input;
    input.slots = slot_pointers_.data();
    if (program.op->keeps_combination()) {
      combine_for(program);
      input.k = combination_.data();
    }
    if (program_.support) {
      support_offsets(program.load_phase, scale_.data(), false);
      const double omega = program_.problem->support.pulsation;
      for (int lane = 0; lane < program_.width; ++lane) scale_.data()[lane] *= omega * omega;
      input.scale = scale_.data();
    }
    input.load = distributed_load(plan.load, time());
    program.op->free_step(input);
    if (program_.tangents > 0 && input.load) remove_load(program, input.load);
    if (state.delassus) contact(program, state, program.op->unknown());
    z = program.op->unknown();
  } else {
    // Nothing to solve: z = 0.
    elastic_.fill(0.0);
  }
  if (observer) {
    StageView view;
    view.stage = index;
    view.plan = &plan;
    view.program = &program;
    view.starting = !start_states_.empty() && &program >= program_.start.data() &&
                    &program < program_.start.data() + program_.start.size();
    view.time = time();
    view.from = view.time + program.facts.from * program_.h;
    view.to = view.time + program.facts.to * program_.h;
    view.slots = slot_pointers_.data();
    view.z = z;
    if (state.delassus) {
      view.effort = state.effort_pointers.data();
      view.efforts = static_cast<int>(state.effort_pointers.size());
      view.outcome = outcome_.data();
      view.touched_lanes = state.touched_lanes;
      view.free = state.free.data();
      view.contact_lanes = state.contact_lanes;
    }
    observer->stage_solved(*this, view);
  }
  const StageProgram* next = nullptr;
  const bool last = index + 1 == static_cast<int>(program_.stages.size());
  const StageProgram& following = program_.stages[last ? 0 : static_cast<std::size_t>(index) + 1];
  if (following.op && following.op->keeps_combination() && &program >= program_.stages.data() &&
      &program < program_.stages.data() + program_.stages.size())
    next = &following;
  kernels_.update(static_cast<long>(combination_.size()), slot_count(), slots_.data(), z, state.update.data(),
                  next ? next->folded.stiffness_history.data() : nullptr, combination_.data());
  combined_for_ = next;
  // The unknown of a lane that froze during this stage was whatever stopped it.
  for (; frozen_now_ != 0; frozen_now_ &= frozen_now_ - 1) clear_lane(std::countr_zero(frozen_now_));
}

// Gap test and approach test: a side that is open has an infinite bound; a closed one may rebound.
void Marcher::open_gates(StageProgram& program, StageState& state) {
  const VelocityGate& gate = *program.gate;
  const int points = lower_.rows(), T = program_.width;
  std::vector<const double*>& slots = slot_pointers_;
  const double* offset = nullptr;
  const auto measure = [&](const std::vector<double>& weights, const PhaseWeights& phase, bool rate, Block& out) {
    if (program_.support) {
      support_offsets(phase, offset_.data(), rate);
      offset = offset_.data();
    }
    kernels_.measure(program_.model->contact().view(), slot_count(), slots.data(), weights.data(), offset, out.data());
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

std::uint32_t Marcher::measure_contact(StageProgram& program, StageState& state, const double* z) {
  const bool gated = program.gate.has_value();
  if (gated) {
    open_gates(program, state);
    if (state.closed_lanes == 0 && state.contact_lanes == 0) return 0;
    if (state.closed_lanes == 0) {
      state.gate_lower.fill(-infinity);
      state.gate_upper.fill(infinity);
    }
  }
  std::array<const double*, most_slots + 1> slots{};
  std::copy(slot_pointers_.begin(), slot_pointers_.end(), slots.begin());
  slots[static_cast<std::size_t>(slot_count())] = z;
  const double* offset = nullptr;
  if (program_.support) {
    support_offsets(program.measure_phase, offset_.data(), gated);
    offset = offset_.data();
  }
  kernels_.measure(program_.model->contact().view(), slot_count() + 1, slots.data(), state.measure_weights.data(),
                   offset, state.free.data());
  if (state.rate.rows() > 0) {
    if (program_.support) support_offsets(program.rate_phase, offset_.data(), true);
    kernels_.measure(program_.model->contact().view(), slot_count() + 1, slots.data(), state.rate_weights.data(),
                     offset, state.rate.data());
  }
  if (state.before.rows() > 0) {
    if (program_.support) support_offsets(program.before_phase, offset_.data(), false);
    kernels_.measure(program_.model->contact().view(), slot_count() + 1, slots.data(), state.before_weights.data(),
                     offset, state.before.data());
  }
  const Block& lower = gated ? state.gate_lower : lower_;
  const Block& upper = gated ? state.gate_upper : upper_;
  return kernels_.outside(lower_.rows(), state.free.data(), lower.data(), upper.data());
}

bool Marcher::finite_measure(const StageState& state, int lane) const {
  for (int i = 0; i < state.free.rows(); ++i)
    if (!std::isfinite(state.free.at(i, lane))) return false;
  return true;
}

void Marcher::contact(StageProgram& program, StageState& state, double* z) {
  const int points = lower_.rows(), rows = program_.model->rows(), T = program_.width;
  const auto size = state.effort[0].size();
  const auto correct = [&](const double* effort) {
    for (int j = 0; j < points; ++j) {
      const double* p = effort + static_cast<std::size_t>(j) * static_cast<std::size_t>(T);
      if (std::any_of(p, p + T, [](double x) { return x != 0; }))
        kernels_.add_column(rows, state.delassus->response(j), p, z);
    }
  };
  for (std::size_t k = state.effort.size(); k-- > 1;)
    std::copy_n(state.effort[k - 1].data(), size, state.effort[k].data());
  for (std::size_t k = 1; k < program.effort.size() && k < state.effort_pointers.size(); ++k) {
    if (program.effort[k] == 0 || !state.effort_pointers[k]) continue;
    for (std::size_t e = 0; e < size; ++e) state.weighted.data()[e] = program.effort[k] * state.effort_pointers[k][e];
    correct(state.weighted.data());
  }
  state.touched_lanes = 0;
  std::uint32_t mask = measure_contact(program, state, z) | state.contact_lanes;
  if (mask == 0) return;
  touched_.clear();
  for (; mask != 0; mask &= mask - 1) {
    const int lane = std::countr_zero(mask);
    if (lane >= lanes() || !status_[static_cast<std::size_t>(lane)].running) continue;
    if (finite_measure(state, lane)) {
      touched_.push_back(lane);
      state.touched_lanes |= 1u << lane;
    } else
      freeze(lane, {.cause = EndCause::position_not_finite});
  }
  for (const int lane : touched_) outcome_[static_cast<std::size_t>(lane)] = {};
  ReducedProblem problem;
  problem.points = points;
  problem.lanes = T;
  problem.delassus = state.delassus.get();
  problem.reach = program.measure_z * program.effort[0];
  problem.free = state.free.data();
  problem.lower = program.gate ? state.gate_lower.data() : lower_.data();
  problem.upper = program.gate ? state.gate_upper.data() : upper_.data();
  problem.rate_reach = program.compliance ? program.compliance->rate.z * program.effort[0] : 0.0;
  problem.rate_free = state.rate.rows() > 0 ? state.rate.data() : nullptr;
  problem.before = state.before.rows() > 0 ? state.before.data() : nullptr;
  problem.memory = memory_.rows() > 0 ? memory_.data() : nullptr;
  problem.effort = state.effort[0].data();
  problem.touched = touched_;
  problem.outcome = outcome_.data();
  program_.law->solve(problem);
  state.contact_lanes = 0;
  for (const int lane : touched_) {
    bool active = false, finite = true;
    for (int i = 0; i < points; ++i) {
      const double p = state.effort[0].at(i, lane);
      active = active || p != 0;
      finite = finite && std::isfinite(p);
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
  if (program_.tangents > 0) tangent_contact(program, state);
  if (program.effort[0] == 1.0) {
    if (state.contact_lanes != 0) correct(state.effort[0].data());
  } else if (program.effort[0] != 0 && state.contact_lanes != 0) {
    for (std::size_t e = 0; e < size; ++e) state.weighted.data()[e] = program.effort[0] * state.effort[0].data()[e];
    correct(state.weighted.data());
  }
}

double Marcher::energy_bound(int lane) const {
  const double bound = std::max(lane_bounds_[static_cast<std::size_t>(lane)], load_bound_);
  return bound == 0 ? infinity : bound;
}

bool Marcher::beyond_bound(int lane, double energy) {
  // A load that depends on time may have grown since the start.
  const bool looks = program_.load && !program_.load_constant && time() > load_known_until_;
  if (looks && energy > std::max(lane_bounds_[static_cast<std::size_t>(lane)], load_bound_)) {
    load_known_until_ = 2 * time();
    load_bound_ = std::max(load_bound_, divergence_factor * energy_scale_->of_load(load_known_until_));
  }
  return energy > energy_bound(lane);
}

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
                    .factor = divergence_factor});
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
  for (auto* states : {&start_states_, &stage_states_})
    for (auto& state : *states) {
      for (Block& effort : state->effort)
        for (int i = 0; i < effort.rows(); ++i) effort.at(i, lane) = 0;
      state->contact_lanes &= ~(1u << lane);
    }
  for (int k = 0; k < program_.tangents; ++k) {
    const int tangent = tangent_lane(lane, k);
    frozen_now_ |= 1u << tangent;
    clear_lane(tangent);
    for (auto* states : {&start_states_, &stage_states_})
      for (auto& state : *states)
        for (Block& effort : state->effort)
          for (int i = 0; i < effort.rows(); ++i) effort.at(i, tangent) = 0;
  }
  amplitude_.at(0, lane) = 0;
  for (int i = 0; i < memory_.rows(); ++i) memory_.at(i, lane) = 0;
  for (int i = 0; i < lower_.rows(); ++i) {
    lower_.at(i, lane) = -infinity;
    upper_.at(i, lane) = infinity;
  }
}

// What a lane's spec says of its surroundings: clamp and stops, and the energies to expect.
void Marcher::place_lane(int lane) {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  lane_bounds_[static_cast<std::size_t>(lane)] = divergence_factor * energy_scale_->of_lane(spec);
  amplitude_.at(0, lane) = spec.amplitude;
  cos_phase_.at(0, lane) = std::cos(spec.phase);
  sin_phase_.at(0, lane) = std::sin(spec.phase);
  phases_ = phases_ || spec.phase != 0;
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

void Marcher::clear_lane(int lane) {
  for (Block& block : blocks_)
    for (int i = 0; i < block.rows(); ++i) block.at(i, lane) = 0;
  combined_for_ = nullptr;
}

Eigen::VectorXd Marcher::position(int lane) const {
  Eigen::VectorXd q(program_.model->rows());
  for (int i = 0; i < q.size(); ++i) q[i] = blocks_[0].at(i, lane);
  return program_.model->to_nodal(q);
}

double Marcher::tip(int lane) const {
  const RowMatrix& row = program_.model->tip();
  double sum = support(lane, time());
  for (std::size_t e = 0; e < row.index.size(); ++e) sum += row.value[e] * blocks_[0].at(row.index[e], lane);
  return sum;
}

double Marcher::depth(int lane, int point, double relative, double support) const {
  const LaneSpec& spec = program_.lanes[static_cast<std::size_t>(lane)];
  return std::max(spec.lower[point] - (relative + support), relative + support - spec.upper[point]);
}

double Marcher::penetration(int lane) const {
  if (!program_.contact) return 0;
  const RowMatrix& rows = program_.model->contact();
  const double phi = support(lane, time());
  double deepest = 0;
  for (int j = 0; j < rows.rows(); ++j) {
    double sum = 0;
    for (int e = rows.start[static_cast<std::size_t>(j)]; e < rows.start[static_cast<std::size_t>(j) + 1]; ++e)
      sum += rows.value[static_cast<std::size_t>(e)] * blocks_[0].at(rows.index[static_cast<std::size_t>(e)], lane);
    deepest = std::max(deepest, depth(lane, j, sum, phi));
  }
  return deepest;
}

int Marcher::delassus_columns() const {
  int columns = 0;
  for (const auto& state : stage_states_)
    if (state->delassus) columns += state->delassus->computed();
  return columns;
}

}  // namespace ricochet
