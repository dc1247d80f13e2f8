#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ricochet/measure/energy_audit.hpp>

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
      compliant_(marcher.law().reads().has_value()) {
  const auto rows = static_cast<std::size_t>(model_.rows());
  lanes_.resize(static_cast<std::size_t>(marcher.lanes()));
  for (Lane& lane : lanes_) {
    lane.increment.assign(rows, 0.0);
    lane.signs.assign(static_cast<std::size_t>(model_.problem().points()), 0);
  }
  first_.resize(rows);
  second_.resize(rows);
}

void EnergyAudit::combine(const double* const* slots, const double* z, const Combination& c, int lane,
                          std::vector<double>& out) const {
  const auto T = static_cast<std::size_t>(T_), l = static_cast<std::size_t>(lane);
  std::fill(out.begin(), out.end(), 0.0);
  accumulate(c.z, z, T, l, out);
  for (std::size_t j = 0; j < c.slots.size(); ++j) accumulate(c.slots[j], slots[j], T, l, out);
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

void EnergyAudit::stage_solved(const Marcher& marcher, const StageView& view) {
  // A scheme with an energy of its own has it before the first step, unless its start rule moves time.
  const bool declares = !marcher.program().plan.energy.empty();
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    const bool starting = view.plan->work == std::nullopt;
    if (view.stage == 0) {
      std::fill(state.increment.begin(), state.increment.end(), 0.0);
      state.step_loads = state.step_damping = state.step_contact = 0;
      if (declares && !state.has_scheme && !starting) {
        state.energy.scheme_start = scheme_energy(marcher, lane);
        state.now.scheme = state.energy.scheme_start;
        state.has_scheme = true;
      }
    }
    combine(view.slots, view.z, view.plan->increment, lane, first_);
    for (std::size_t i = 0; i < first_.size(); ++i) state.increment[i] += first_[i];
    if (view.effort) count_contact(view, lane);
    if (starting) continue;
    const WorkForm& work = *view.plan->work;
    const bool loads = marcher.program().support || marcher.program().load;
    const bool contact = view.effort && (((view.contact_lanes >> lane) & 1u) || work.effort.size() > 1);
    const bool damped = damping_.stiffness != 0 || damping_.mass != 0;
    if (!loads && !contact && !damped) continue;
    std::vector<double>& s = first_;
    combine(view.slots, view.z, work.displacement, lane, s);
    if (damped) {
      combine(view.slots, view.z, work.rate, lane, second_);
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
    if (contact) {
      const double lift = marcher.program().support ? marcher.support_levels(lane, view.time, work.support) : 0.0;
      for (int j = 0; j < model_.problem().points(); ++j) {
        double effort = 0;
        for (std::size_t k = 0; k < work.effort.size(); ++k)
          if (view.effort[k]) effort += work.effort[k] * view.effort[k][j * T_ + lane];
        if (effort == 0) continue;
        state.step_contact += effort * (model_.contact().times(j, s.data()) + lift);
        state.step_loads -= effort * lift;
      }
    }
  }
}

void EnergyAudit::count_contact(const StageView& view, int lane) {
  Lane& state = lanes_[static_cast<std::size_t>(lane)];
  ContactTotals& contact = state.contact;
  const bool was_active = contact.active > 0;
  contact.force = 0;
  contact.active = 0;
  if (!((view.contact_lanes >> lane) & 1u) && !was_active) return;
  bool changed = false;
  for (int j = 0; j < model_.problem().points(); ++j) {
    const double p = view.effort[0][j * T_ + lane];
    const auto sign = static_cast<signed char>(p > 0 ? 1 : (p < 0 ? -1 : 0));
    signed char& before = state.signs[static_cast<std::size_t>(j)];
    changed = changed || sign != before;
    before = sign;
    if (sign == 0) continue;
    ++contact.active;
    contact.force += p;
    contact.impulse += h_ * std::abs(p);
  }
  if (changed) ++contact.active_set_changes;
  if (contact.active > 0) {
    ++contact.contact_steps;
    contact.residual = std::max(contact.residual, view.outcome[lane].residual);
    if (!was_active) {
      ++contact.impacts;
      if (contact.first_impact < 0) contact.first_impact = view.time + h_;
    }
  } else if (was_active && contact.first_release < 0) {
    contact.first_release = view.time;
  }
}

void EnergyAudit::step_done(Marcher& marcher) {
  const RowMatrix& tip = model_.tip();
  const auto T = static_cast<std::size_t>(T_);
  for (int lane = 0; lane < marcher.lanes(); ++lane) {
    if (!marcher.status(lane).running) continue;
    Lane& state = lanes_[static_cast<std::size_t>(lane)];
    const double* q = marcher.slot(0);
    std::vector<double>& middle = second_;
    for (std::size_t i = 0; i < middle.size(); ++i)
      middle[i] = q[i * T + static_cast<std::size_t>(lane)] - 0.5 * state.increment[i];
    EnergySample sample;
    sample.kinetic = 0.5 * mass_(state.increment.data()) / (h_ * h_);
    sample.elastic = 0.5 * stiffness_(middle.data());
    const double t = marcher.time();
    if (marcher.program().contact) {
      state.penetration = marcher.penetration(lane);
      state.contact.deepest_penetration = std::max(state.contact.deepest_penetration, state.penetration);
      if (compliant_) {
        const double phi = 0.5 * (marcher.support(lane, t) + marcher.support(lane, t - h_));
        for (int j = 0; j < model_.problem().points(); ++j) {
          const double depth = marcher.depth(lane, j, model_.contact().times(j, middle.data()), phi);
          if (depth > 0) sample.contact += marcher.law().potential(depth, lane);
        }
      }
    }
    double tip_increment = marcher.support(lane, t) - marcher.support(lane, t - h_);
    tip_increment += tip.times(0, state.increment.data());
    state.tip_velocity = tip_increment / h_;
    const bool declares = !marcher.program().plan.energy.empty();
    sample.scheme = declares ? scheme_energy(marcher, lane) : sample.common();
    EnergyTotals& totals = state.energy;
    totals.work_of_loads += state.step_loads;
    totals.work_of_damping += state.step_damping;
    totals.work_of_contact += state.step_contact;
    if (state.has_scheme)
      totals.largest_step_gain =
          std::max(totals.largest_step_gain, sample.scheme - state.now.scheme - state.step_loads);
    if (!state.has_first) totals.first = sample;
    if (!state.has_scheme) totals.scheme_start = sample.scheme;
    state.has_first = state.has_scheme = true;
    state.now = totals.last = sample;
    const double energy = sample.common();
    if (!std::isfinite(energy) || !std::isfinite(sample.scheme))
      marcher.freeze(lane, "the energy is not finite");
    else if (marcher.beyond_bound(lane, energy))
      marcher.freeze(lane,
                     fmt::format("the energy {:.3g} J passed the bound {:.3g} J", energy, marcher.energy_bound(lane)));
  }
}

}  // namespace ricochet
