#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/engine/flight/flight.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

namespace ricochet {
namespace {

// out += w · lane of x; the stride is written out for one lane, where the loop then vectorises.
void accumulate(double w, const double* x, std::size_t stride, std::size_t lane, std::vector<double>& out) {
  if (w == 0) return;
  const std::size_t rows = out.size();
  if (stride == 1)
    for (std::size_t i = 0; i < rows; ++i) out[i] += w * x[i];
  else
    for (std::size_t i = 0; i < rows; ++i) out[i] += w * x[i * stride + lane];
}

}  // namespace

EnergyAudit::EnergyAudit(const Marcher& marcher)
    : model_(*marcher.program().model),
      mass_(QuadraticForm::of(model_.inertia())),
      stiffness_(model_.stiffness()),
      damping_(model_.problem().damping),
      h_(marcher.program().h),
      T_(marcher.width()),
      compliant_(marcher.law().reads().has_value()),
      mean_velocity_(marcher.program().velocity_offset != 0) {
  const auto rows = static_cast<std::size_t>(model_.rows());
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    Lane& state = lanes_.emplace_back(model_.problem().points());
    state.increment.assign(rows, 0.0);
    state.duration = h_;
    state.energy.first = state.energy.last = state.now = initial_energy(marcher, lane);
    // A scheme with an energy of its own has it once its start rule is through.
    state.energy.own_energy = !marcher.program().plan.energy.empty();
    state.has_scheme = !state.energy.own_energy;
    if (state.has_scheme) state.energy.scheme_start = state.now.scheme;
  }
  for (const Stage& stage : marcher.program().plan.stages) balances_ = balances_ || stage.work.has_value();
  first_.resize(rows);
  second_.resize(rows);
}

void EnergyAudit::combine(const double* const* slots, const double* z, const Combination& c, int lane,
                          std::vector<double>& out) const {
  const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane);
  std::fill(out.begin(), out.end(), 0.0);
  if (z) accumulate(c.z, z, T, l, out);
  for (std::size_t j = 0; j < c.slots.size(); ++j) accumulate(c.slots[j], slots[j], T, l, out);
}

void EnergyAudit::combine(const StageView& view, const Combination& c, int lane, std::vector<double>& out) const {
  combine(view.slots, view.z, c, lane, out);
  if (view.w) accumulate(c.w, view.w, static_cast<std::size_t>(T_), static_cast<std::size_t>(lane), out);
}

double EnergyAudit::scheme_energy(const Marcher& marcher, int lane) {
  double energy = 0;
  for (const QuadraticTerm& term : marcher.program().plan.energy) {
    if (term.coefficient == 0) continue;
    const bool mass = term.matrix == QuadraticTerm::Matrix::M;
    std::fill(first_.begin(), first_.end(), 0.0);
    for (std::size_t j = 0; j < term.slots.size(); ++j)
      accumulate(term.slots[j], marcher.slot(static_cast<int>(j)), static_cast<std::size_t>(T_),
                 static_cast<std::size_t>(lane), first_);
    energy += term.coefficient * (mass ? mass_(first_.data()) : stiffness_(first_.data()));
  }
  return energy;
}

// The slots hold the state at time t, `increment` what led to it.
EnergySample EnergyAudit::sample(const Marcher& marcher, const double* const* slots, double t, int lane) {
  const Lane& state = lanes_[static_cast<std::size_t>(lane)];
  const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane);
  EnergySample sample;
  std::vector<double>& place = second_;
  if (mean_velocity_) {
    for (std::size_t i = 0; i < place.size(); ++i) place[i] = slots[0][i * T + l] - 0.5 * state.increment[i];
    sample.kinetic = 0.5 * mass_(state.increment.data()) / (state.duration * state.duration);
  } else {
    combine(slots, nullptr, marcher.program().plan.velocity, lane, first_);
    for (std::size_t i = 0; i < place.size(); ++i) place[i] = slots[0][i * T + l];
    sample.kinetic = 0.5 * mass_(first_.data());
  }
  sample.elastic = 0.5 * stiffness_(place.data());
  if (!marcher.program().contact || !compliant_) return sample;
  double phi = marcher.support(lane, t);
  if (mean_velocity_) phi = 0.5 * (phi + marcher.support(lane, t - state.duration));
  sample.contact = potential(marcher, place.data(), phi, lane);
  return sample;
}

// Of the state that the lane is given, before any rule of the scheme.
EnergySample EnergyAudit::initial_energy(const Marcher& marcher, int lane) {
  const LaneSpec& spec = marcher.program().lanes[static_cast<std::size_t>(lane)];
  const Eigen::VectorXd place = model_.to_model(spec.position), speed = model_.to_model(spec.velocity);
  EnergySample sample;
  sample.kinetic = 0.5 * mass_(speed.data());
  sample.elastic = 0.5 * stiffness_(place.data());
  if (marcher.program().contact && compliant_)
    sample.contact = potential(marcher, place.data(), marcher.support(lane, 0), lane);
  sample.scheme = sample.common();
  return sample;
}

double EnergyAudit::potential(const Marcher& marcher, const double* place, double support, int lane) const {
  const double layer = marcher.law().layer(lane);
  double sum = 0;
  for (int j = 0; j < model_.problem().points(); ++j) {
    const double depth = marcher.depth(lane, j, model_.measured().times(j, place), support);
    if (depth > -layer) sum += marcher.law().potential(depth, lane);
  }
  return sum;
}

void EnergyAudit::stage_solved(const Marcher& marcher, const StageView& view) {
  const StageFacts& facts = view.program->facts;
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    if (view.stage == 0) {
      state.step_loads = state.step_damping = state.step_contact = state.step_scheme = state.step_law = 0;
    }
    const bool balanced = view.plan->work || !view.starting;
    if (!state.has_scheme && balanced) {
      state.energy.scheme_start = scheme_energy(marcher, lane);
      state.now.scheme = state.energy.first.scheme = state.energy.scheme_start;
      state.has_scheme = true;
    }
    const bool moves = facts.to != facts.from;
    if (moves || view.stage == 0) {
      std::fill(state.increment.begin(), state.increment.end(), 0.0);
      if (moves) state.duration = (facts.to - facts.from) * h_;
    }
    combine(view, facts.increment, lane, first_);
    for (std::size_t i = 0; i < first_.size(); ++i) state.increment[i] += first_[i];
    if (view.effort) count_contact(view, lane);
    if (view.plan->work) work(marcher, view, lane);
    for (const LossTerm& term : view.plan->loss) {
      if (term.coefficient == 0 || !balanced) continue;
      combine(view, term.value, lane, first_);
      state.step_scheme +=
          term.coefficient * (term.matrix == EnergyMatrix::M ? mass_(first_.data()) : stiffness_(first_.data()));
    }
  }
}

// The works of one stage, by its test displacement.
void EnergyAudit::work(const Marcher& marcher, const StageView& view, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  const WorkForm& work = *view.plan->work;
  const bool loads = marcher.program().support || marcher.program().load;
  const std::vector<double>& weights = view.program->work_effort;
  const bool contact = view.effort && (((view.contact_lanes >> lane) & 1u) || weights.size() > 1);
  const bool damped = damping_.stiffness != 0 || damping_.mass != 0;
  if (!loads && !contact && !damped) return;
  std::vector<double>& s = first_;
  combine(view, work.displacement, lane, s);
  if (damped) {
    combine(view, work.rate, lane, second_);
    if (damping_.stiffness != 0) state.step_damping += damping_.stiffness * stiffness_(s.data(), second_.data());
    if (damping_.mass != 0) state.step_damping += damping_.mass * mass_(s.data(), second_.data());
  }
  if (marcher.program().support) {
    // −φ'' = ω² φ for the harmonic support.
    const double omega = model_.problem().support.pulsation;
    const double push = omega * omega * marcher.support_levels(lane, view.time, work.load);
    double along = 0;
    for (std::size_t i = 0; i < s.size(); ++i) along += s[i] * model_.support_shape()[static_cast<Eigen::Index>(i)];
    state.step_loads += push * along;
  }
  if (marcher.program().load) {
    const double* load = const_cast<Marcher&>(marcher).distributed_load(work.load, view.time);
    for (std::size_t i = 0; i < s.size(); ++i) state.step_loads += s[i] * load[i];
  }
  if (!contact) return;
  const double lift = marcher.program().support ? marcher.support_levels(lane, view.time, work.support) : 0.0;
  for (int j = 0; j < model_.problem().points(); ++j) {
    double effort = 0;
    for (int k = 0; k < std::min(static_cast<int>(weights.size()), view.efforts); ++k)
      if (view.effort[k]) effort += weights[static_cast<std::size_t>(k)] * view.effort[k][j * T_ + lane];
    if (effort == 0) continue;
    state.step_contact += effort * (model_.measured().times(j, s.data()) + lift);
    state.step_loads -= effort * lift;
  }
}

void EnergyAudit::count_contact(const StageView& view, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  ContactTotals& contact = state.contact;
  if (view.program->opens_instant) state.force = 0;
  const LaneOutcome& outcome = view.outcome[lane];
  if ((view.touched_lanes >> lane) & 1u) {
    contact.most_iterations = std::max(contact.most_iterations, outcome.iterations);
    // Also where no effort is left: a damped law lets go while its spring is still pressed.
    state.step_law += view.program->momentum * outcome.dissipation;
  }
  if ((view.contact_lanes >> lane) & 1u) {
    const double momentum = view.program->momentum;
    for (int j = 0; j < model_.problem().points(); ++j) {
      const double p = view.effort[0][j * T_ + lane];
      if (p == 0) continue;
      state.closed.press(j, p);
      // An effort that gives no momentum only puts a position right: it is no force.
      if (momentum != 0) state.force += p;
      contact.impulse += momentum * std::abs(p);
    }
    contact.residual = std::max(contact.residual, outcome.residual);
  }
  if (view.program->closes_instant) close_instant(view, state);
}

// What an instant of contact was, beside the one before it.
void EnergyAudit::close_instant(const StageView& view, Lane& state) {
  ContactTotals& contact = state.contact;
  contact.force = state.force;
  contact.active = 0;
  if (state.closed.idle()) return;
  const ClosedPoints::Change change = state.closed.end_instant();
  contact.active = change.active;
  contact.active_set_changes += change.changed;
  contact.impacts += change.closings;
  if (contact.active > 0) {
    ++contact.contact_steps;
    contact.spells += !change.was_active;
    if (contact.first_impact < 0) contact.first_impact = view.time + view.program->facts.instant * h_;
  } else if (change.was_active && contact.first_release < 0) {
    contact.first_release = view.from;
  }
}

double EnergyAudit::tip_velocity(int lane) const {
  const Lane& state = lanes_[static_cast<std::size_t>(lane)];
  return (state.lift + model_.tip().times(0, state.increment.data())) / state.duration;
}

void EnergyAudit::step_done(Marcher& marcher) {
  const double t = marcher.time();
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    EnergySample sample = this->sample(marcher, marcher.slots(), t, lane);
    if (marcher.program().contact) {
      state.penetration = marcher.penetration(lane);
      state.contact.deepest_penetration = std::max(state.contact.deepest_penetration, state.penetration);
    }
    state.lift = marcher.support(lane, t) - marcher.support(lane, t - state.duration);
    const bool declares = !marcher.program().plan.energy.empty();
    sample.scheme = declares ? scheme_energy(marcher, lane) : sample.common();
    EnergyTotals& totals = state.energy;
    totals.work_of_loads += state.step_loads;
    totals.work_of_damping += state.step_damping;
    totals.work_of_contact += state.step_contact;
    totals.work_of_scheme += state.step_scheme;
    totals.work_of_law += state.step_law;
    if (state.has_scheme)
      totals.largest_step_gain =
          std::max(totals.largest_step_gain, sample.scheme - state.now.scheme - state.step_loads);
    state.now = totals.last = sample;
    const double energy = sample.common();
    if (!std::isfinite(energy) || !std::isfinite(sample.scheme))
      marcher.freeze(lane, {.cause = EndCause::energy_not_finite});
    else if (marcher.beyond_bound(lane, energy))
      marcher.freeze(lane, {.cause = EndCause::energy_beyond, .value = energy, .bound = marcher.energy_bound(lane)});
  }
}

long long EnergyAudit::may_skip(const Marcher& marcher) {
  const Lane& state = lanes_.front();
  const bool told = state.energy.own_energy && state.has_scheme && marcher.program().flight->free_never_gains();
  return told ? std::numeric_limits<long long>::max() : 0;
}

// Flights march one lane.
void EnergyAudit::skipped(Marcher& marcher, const SkippedSteps& steps) {
  Lane& state = lanes_.front();
  EnergyTotals& totals = state.energy;
  totals.work_of_loads += steps.works.loads;
  totals.work_of_damping += steps.works.damping;
  totals.work_of_scheme += steps.works.scheme;
  state.now.scheme = scheme_energy(marcher, 0);
  if (steps.held.empty()) return;
  ContactTotals& contact = state.contact;
  contact.contact_steps += steps.steps;
  const double momentum = marcher.program().stages.front().momentum;
  steps.flight->each_effort([&](std::span<const double> efforts) {
    for (const double p : efforts) contact.impulse += momentum * std::abs(p);
  });
}

}  // namespace ricochet
