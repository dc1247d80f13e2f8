#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/engine/left_out.hpp>
#include <ricochet/kernels/flight_kernels.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

namespace ricochet {

void EnergyTotals::add(const Works& works) {
  work_of_loads += works.loads;
  work_of_damping += works.damping;
  work_of_contact += works.contact;
  work_of_friction += works.friction;
  work_of_scheme += works.scheme;
  work_of_law += works.law;
}

EnergyAudit::EnergyAudit(const Marcher& marcher, SamplingMode sampling)
    : model_(*marcher.program().model),
      mass_(QuadraticForm::of(model_.inertia())),
      stiffness_(model_.stiffness()),
      energies_(marcher, mass_, stiffness_),
      works_(marcher, mass_, stiffness_),
      sampling_(sampling),
      h_(marcher.program().h),
      T_(marcher.width()),
      places_(static_cast<std::size_t>(model_.problem().points())),
      compliant_(marcher.law().reads().has_value()),
      mean_velocity_(marcher.program().velocity_offset != 0),
      flies_(marcher.program().flight != nullptr) {
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    Lane& state = lanes_.emplace_back(model_.problem().points(), StartContact(marcher, lane));
    if (marcher.program().increment_slot < 0) state.increment = Block(model_.rows(), 1);
    state.duration = h_;
    state.energy.first = state.energy.last = state.now = initial_energy(marcher, lane);
    state.energy.driven = marcher.program().support || !marcher.motions().empty() ||
                          (marcher.program().load && !marcher.program().load_constant);
    // A scheme with an energy of its own has it once its start rule is through.
    state.energy.own_energy = !marcher.program().plan.energy.empty();
    state.has_scheme = !state.energy.own_energy;
    if (state.has_scheme) state.energy.scheme_start = state.now.scheme;
  }
  bool all = true;
  for (const Stage& stage : marcher.program().plan.stages) {
    balances_ = balances_ || stage.work.has_value();
    all = all && stage.work.has_value();
  }
  for (Lane& state : lanes_) state.balanced = all && state.energy.own_energy;
  for (const auto* stages : {&marcher.program().start, &marcher.program().stages})
    for (const StageProgram& stage : *stages)
      memory_ =
          std::max({memory_, static_cast<int>(stage.work_effort.size()), static_cast<int>(stage.friction_work.size())});
  ends_measured_ = measures_the_end(marcher.program());
  if (marcher.program().increment_slot < 0) {
    for (const StageProgram& stage : marcher.program().start) start_ways_.emplace_back(stage.facts.increment);
    for (const StageProgram& stage : marcher.program().stages) ways_.emplace_back(stage.facts.increment);
  }
  scratch_ = Block(model_.rows(), 1);
  for (int k = 0; k < static_cast<int>(marcher.program().stages.size()); ++k)
    asks_.squares.push_back(works_.squares(k));
}

EnergySample EnergyAudit::sample(const Marcher& marcher, int lane) {
  const Lane& state = lanes_[static_cast<std::size_t>(lane)];
  const StateEnergies::Values values = energies_.read(marcher.slots(), state.increment.data(), state.duration, lane);
  EnergySample sample;
  sample.kinetic = values.kinetic;
  sample.elastic = values.elastic;
  if (marcher.program().contact && compliant_) {
    const double t = marcher.time();
    sample.contact = potential(marcher, energies_.place(), t, mean_velocity_ ? t - state.duration : t, lane);
  }
  sample.scheme = state.energy.own_energy ? values.scheme : sample.common();
  if (load_.size() > 0)
    sample.load = -flight_kernels().dot(model_.rows(), load_.data(), energies_.place()) - load_level_;
  return sample;
}

void EnergyAudit::count_load(const Marcher& marcher, const Eigen::VectorXd& load, double level) {
  load_.resize(model_.rows());
  model_.load_to_model(load.data(), load_.data());
  load_level_ = level;
  energies_.keep_place();
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
    Lane& state = lanes_[lane];
    state.now.load = -load.dot(marcher.program().lanes[lane].position) - level;
    state.energy.first.load = state.energy.last.load = state.now.load;
  }
}

// Of the state that the lane is given, before any rule of the scheme.
EnergySample EnergyAudit::initial_energy(const Marcher& marcher, int lane) {
  const LaneSpec& spec = marcher.program().lanes[static_cast<std::size_t>(lane)];
  const Eigen::VectorXd place = model_.to_model(spec.position), speed = model_.to_model(spec.velocity);
  EnergySample sample;
  sample.kinetic = 0.5 * mass_(speed.data());
  sample.elastic = 0.5 * stiffness_(place.data());
  if (marcher.program().contact && compliant_) sample.contact = potential(marcher, place.data(), 0, 0, lane);
  sample.scheme = sample.common();
  return sample;
}

// Where supports stand in the mean of two times, which may be one.
double EnergyAudit::potential(const Marcher& marcher, const double* place, double now, double before, int lane) {
  const auto mean = [&](auto&& lift) { return now == before ? lift(now) : 0.5 * (lift(now) + lift(before)); };
  const double support = mean([&](double t) { return marcher.support(lane, t); });
  for (int j = 0; j < model_.problem().points(); ++j) {
    const double lift = support + mean([&](double t) { return marcher.motions().point(j, t); });
    places_[static_cast<std::size_t>(j)] = model_.measured().times(j, place) + lift;
  }
  return marcher.stored(lane, places_.data());
}

bool EnergyAudit::asks(const Lane& state, long long step) const {
  return sampling_ == SamplingMode::every_step || !state.balanced || !state.has_scheme || step == asked_;
}

void EnergyAudit::begin_step(const Marcher& marcher, const StageView& view, Lane& state) {
  // A start rule that moves no time is no step.
  state.since += state.step;
  state.step = {};
  state.touched = view.starting;
  const long long step = marcher.step() + 1;
  state.asked = asks(state, step);
  state.sampled = state.asked || state.sample_next || step % Marcher::check_interval == 0;
  state.sample_next = false;
}

// What the position moves by, where the energies after the step are looked at and no slot holds it.
void EnergyAudit::follow_position(const StageView& view, int lane, bool moves) {
  Block& increment = lanes_[static_cast<std::size_t>(lane)].increment;
  if (moves || view.stage == 0) increment.fill(0.0);
  const WeighedTerms& way = (view.starting ? start_ways_ : ways_)[static_cast<std::size_t>(view.stage)];
  const double* moved = LaneSum(way, view.slots, view.z, view.w, T_, lane).write(scratch_);
  for (std::size_t i = 0; i < scratch_.size(); ++i) increment.data()[i] += moved[i];
}

// The balance begins before the first stage that has a work form, with what contact took until then.
void EnergyAudit::start_balance(const StageView& view, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  EnergyTotals& totals = state.energy;
  state.now.scheme = energies_.scheme(view.slots, lane);
  totals.scheme_start = state.now.scheme - totals.work_of_contact - totals.work_of_friction - totals.work_of_loads;
  for (const Works* works : {&state.since, &state.step})
    totals.scheme_start -= works->contact + works->friction + works->loads;
  state.has_scheme = true;
}

void EnergyAudit::stage_solved(const Marcher& marcher, const StageView& view) {
  const StageFacts& facts = view.program->facts;
  const bool moves = facts.to != facts.from, balanced = view.plan->work || !view.starting;
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    if (view.stage == 0) begin_step(marcher, view, state);
    if (state.start.any()) state.start.read(marcher, view.slots, view.from);
    if (!state.has_scheme && balanced) start_balance(view, lane);
    if (moves) state.duration = (facts.to - facts.from) * h_;
    if (state.sampled && !ways_.empty()) follow_position(view, lane, moves);
    const bool pushed = ((view.contact_lanes >> lane) & 1u) != 0;
    state.idle = pushed ? 0 : state.idle + 1;
    if (view.effort && (pushed || !state.still || ((view.touched_lanes >> lane) & 1u) != 0))
      count_contact(marcher, view, lane);
    works_.add(marcher, view, lane, balanced, state.idle < memory_, state.step);
  }
  if (view.starting) asks_.next_shown = next_shown(marcher);
}

void EnergyAudit::count_contact(const Marcher& marcher, const StageView& view, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  ContactTotals& contact = state.contact;
  state.still = false;
  if (view.program->opens_instant) state.force = 0;
  const LaneOutcome& outcome = view.outcome[lane];
  if ((view.touched_lanes >> lane) & 1u) {
    state.touched = true;
    contact.most_iterations = std::max(contact.most_iterations, outcome.iterations);
    // Also where no effort is left: a damped law lets go while its spring is still pressed.
    state.step.law += view.program->momentum * outcome.dissipation;
  }
  if ((view.contact_lanes >> lane) & 1u) {
    const double momentum = view.program->momentum;
    marcher.each_push(view, lane, [&](int j, double p) {
      // The sides of a clearance are one stop.
      const SemiDiscrete& problem = model_.problem();
      state.closed.press(problem.stop_row(j), problem.round(j) ? -std::abs(p) : p);
      state.force += view.program->force_share * (problem.circle_axis(j) < 0 ? p : view.effort[0][j * T_ + lane]);
      contact.impulse += momentum * std::abs(p);
    });
    contact.residual = std::max(contact.residual, outcome.residual);
  }
  if (view.program->closes_instant) close_instant(view, state);
}

// Whether a stop that closes has held its point, or a clearance one of its sides, from the start.
bool EnergyAudit::held_at_start(StartContact& start, int point, int side) const {
  const std::vector<Clearance>& clearances = model_.problem().clearances;
  const auto found =
      std::find_if(clearances.begin(), clearances.end(), [&](const Clearance& one) { return one.first == point; });
  if (found == clearances.end()) return start.take(point, side);
  for (int row = found->first; row <= found->last(); ++row)
    if (start.holds(row, 1) || start.holds(row, -1)) return true;
  return false;
}

// What an instant of contact was, beside the one before it.
void EnergyAudit::close_instant(const StageView& view, Lane& state) {
  ContactTotals& contact = state.contact;
  contact.force = state.force;
  contact.active = 0;
  state.still = state.closed.idle();
  if (state.still) return;
  int impacts = 0;
  const ClosedPoints::Change change = state.closed.end_instant([&](int point, int before, int now) {
    impacts += now != 0 && now != before && !(state.start.any() && held_at_start(state.start, point, now));
  });
  contact.active = change.active;
  contact.active_set_changes += change.changed;
  contact.impacts += impacts;
  if (contact.active > 0) {
    ++contact.contact_steps;
    contact.spells += !change.was_active;
    if (contact.first_impact < 0 && impacts > 0) contact.first_impact = view.time + view.program->facts.instant * h_;
  } else if (change.was_active && contact.first_release < 0) {
    contact.first_release = view.from;
  }
}

double EnergyAudit::tip_velocity(int lane) const {
  const Lane& state = lanes_[static_cast<std::size_t>(lane)];
  return state.tip_way / state.duration;
}

double EnergyAudit::last_way(const Marcher& marcher, const RowMatrix& rows, int row, int lane) const {
  const int slot = marcher.program().increment_slot;
  const Block& own = lanes_[static_cast<std::size_t>(lane)].increment;
  if (slot < 0) return model_.times(rows, row, own.data());
  if (T_ == 1) return model_.times(rows, row, marcher.slot(slot));
  const auto i = static_cast<std::size_t>(row);
  double sum = 0;
  for (auto e = static_cast<std::size_t>(rows.start[i]); e < static_cast<std::size_t>(rows.start[i + 1]); ++e)
    sum += rows.value[e] * marcher.slot(slot)[static_cast<std::ptrdiff_t>(rows.index[e]) * T_ + lane];
  return sum;
}

double EnergyAudit::lost_at_stops(int lane) const {
  const Lane& state = lanes_[static_cast<std::size_t>(lane)];
  return -(state.energy.work_of_contact + state.since.contact) -
         (state.energy.last.contact - state.energy.first.contact);
}

void EnergyAudit::step_done(Marcher& marcher) {
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    if (marcher.program().contact) {
      state.penetration = ends_measured_ && !state.touched ? 0 : marcher.penetration(lane, ends_measured_);
      state.contact.deepest_penetration = std::max(state.contact.deepest_penetration, state.penetration);
    }
    state.since += state.step;
    state.gain = std::max(state.gain, state.step.gain());
    ++state.steps;
    const double worked = std::abs(state.step.loads) + std::abs(state.step.damping) + std::abs(state.step.contact) +
                          std::abs(state.step.scheme);
    state.step = {};
    if (state.sampled) take_sample(marcher, lane);
    state.sample_next = alarms(state, worked);
  }
  asks_.next_shown = next_shown(marcher);
}

// Of one lane: the next step after which energies are read; 0 where every step is shown. Steps are left out where the
// squares that a step adds up are all that its works ask without contact. Flights may leave out steps that cannot gain
// energy.
long long EnergyAudit::next_shown(const Marcher& marcher) const {
  const Lane& state = lanes_.front();
  if (flies_) {
    const Flight& flight = *marcher.program().flight;
    bool told = state.energy.own_energy && state.has_scheme && flight.free_never_gains();
    // What springs give in a step only its works tell.
    if (state.contact.active > 0 && !flight.closed_cause().empty()) told = told && state.balanced;
    return told ? never : 0;
  }
  const bool contact = marcher.program().contact;
  const bool seldom = sampling_ == SamplingMode::seldom && state.balanced && state.has_scheme && !state.sample_next;
  if (!seldom || !works_.squares_alone() || memory_ > 1) return 0;
  if (contact && !(ends_measured_ && state.still)) return 0;
  const long long step = marcher.step(), regular = (step / Marcher::check_interval + 1) * Marcher::check_interval;
  return asked_ > step ? std::min(asked_, regular) : regular;
}

void EnergyAudit::interval(Marcher& marcher, const StepInterval& steps) {
  if (steps.flight)
    add_flown(marcher, steps);
  else
    add_marched(marcher, steps.marched);
  asks_.next_shown = next_shown(marcher);
}

void EnergyAudit::add_marched(const Marcher& marcher, std::span<const FreeStep> steps) {
  Lane& state = lanes_.front();
  double most = 0;
  for (const FreeStep& step : steps) {
    Works works;
    works_.add(marcher, step, works);
    state.since.loads += works.loads;
    state.since.damping += works.damping;
    state.gain = std::max(state.gain, works.gain());
    most = std::max(most, std::abs(works.loads) + std::abs(works.damping));
  }
  state.steps += static_cast<int>(steps.size());
  state.idle += static_cast<int>(steps.size());
  state.penetration = 0;
  state.sample_next = alarms(state, most);
}

// Whether that much may be the beginning of a lane that blows up.
bool EnergyAudit::alarms(const Lane& state, double worked) {
  return !(worked <= alarming * std::max(state.now.common(), state.energy.brought_in()));
}

void EnergyAudit::take_sample(Marcher& marcher, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  const double t = marcher.time();
  const EnergySample sample = this->sample(marcher, lane);
  if (state.asked)
    state.tip_way = last_way(marcher, model_.tip(), 0, lane) + marcher.support(lane, t) -
                    marcher.support(lane, t - state.duration) + marcher.motions().tip(t) -
                    marcher.motions().tip(t - state.duration);
  confirm(state, sample.scheme, false);
  state.now = state.energy.last = sample;
  const double energy = sample.common();
  if (!std::isfinite(energy) || !std::isfinite(sample.scheme))
    marcher.freeze(lane, {.cause = EndCause::energy_not_finite});
  else if (marcher.beyond_bound(lane, energy))
    marcher.freeze(lane, {.cause = EndCause::energy_beyond, .value = energy, .bound = marcher.energy_bound(lane)});
}

// The works since the last sample enter the totals, and explain what the scheme's energy has become; a single step
// needs no explanation.
void EnergyAudit::confirm(Lane& state, double scheme, bool flown) {
  EnergyTotals& totals = state.energy;
  totals.add(state.since);
  if (state.has_scheme) {
    const double gain = scheme - state.now.scheme - state.since.loads;
    const double unexplained = gain - state.since.gain();
    const double most = state.steps > 1 ? state.gain + std::max(0.0, unexplained) : gain;
    totals.largest_step_gain = std::max(totals.largest_step_gain, flown ? state.gain : most);
    const double scale = std::max({std::abs(scheme), std::abs(state.now.scheme), totals.brought_in()});
    if (state.balanced && !(std::abs(unexplained) <= confirmed * scale)) state.balanced = false;
  }
  state.now.scheme = scheme;
  state.since = {};
  state.gain = 0;
  state.steps = 0;
}

void EnergyAudit::add_flown(const Marcher& marcher, const StepInterval& steps) {
  Lane& state = lanes_.front();
  Works flown;
  flown.loads = steps.works.loads;
  flown.damping = steps.works.damping;
  flown.scheme = steps.works.scheme;
  flown.contact = steps.works.contact;
  flown.law = steps.works.law;
  // The step after them is sampled. No free step gains: what round-off makes of many is no step's gain.
  state.sample_next = true;
  state.gain = std::max(state.gain, steps.works.gain);
  state.since += flown;
  confirm(state, energies_.scheme(marcher.slots(), 0), true);
  if (steps.closed.empty()) return;
  ContactTotals& contact = state.contact;
  contact.contact_steps += steps.instants * steps.steps;
  contact.deepest_penetration = std::max(contact.deepest_penetration, steps.penetration);
  if (const auto pushed = steps.pushed(); !pushed.empty()) {
    const double momentum = marcher.program().stages.front().momentum;
    for (const Flight::Pushed& one : pushed) contact.impulse += momentum * one.sum;
    return;
  }
  steps.each_stage([&](int stage, std::span<const double> efforts, std::span<const double>) {
    const double momentum = marcher.program().stages[static_cast<std::size_t>(stage)].momentum;
    for (const double p : efforts) contact.impulse += momentum * std::abs(p);
  });
}

}  // namespace ricochet
