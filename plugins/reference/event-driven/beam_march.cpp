#include <algorithm>
#include <cmath>
#include <ricochet/contract/said_format.hpp>
#include <utility>

#include "beam_run.hpp"

/// \file
/// The search for the end of a phase.
namespace ricochet::event_driven {

std::variant<int, Refusal> BeamRun::march(ModalPhase& phase, std::array<Guard, 2>& guards, double tolerance) {
  if (out_.events.size() > settings_.events_per_period * (1 + state_.time / first_period_))
    return Refusal{
        said("more than {:g} impacts and releases per period of the first mode by t = {:g} s: the tip chatters, "
             "which modal phases cannot follow. Raise `events`, add damping, or use another reference",
             settings_.events_per_period, state_.time)};
  Reading here = phase.read(state_);
  for (Guard& guard : guards) guard.read(state_.time, here.value);
  while (next_ < grid_.times.size()) {
    if (++looks_ > most_looks)
      return Refusal{said(
          "the search for events needs more than {:g} readings of the gap to reach t = {:g} s: shorten the duration, "
          "lower `modes`, or loosen `tolerance`",
          static_cast<double>(most_looks), grid_.times.back())};
    phase.forget_dead_modes(state_, 1e-30 * scale_);
    phase.measure(state_);
    if (guards[0].waits())
      while (phase.step(level_) > shortest_period_) ++level_;
    const int deepest = deepest_level(phase);
    for (;; ++level_, ++looks_) {
      ahead_ = state_;
      phase.move_by_level(ahead_, level_);
      const Reading there = phase.read(ahead_);
      const double step = phase.step(level_), error = phase.interpolation_error(level_);
      const Cubic cubic{here.value, step * here.slope, there.value, step * there.slope};
      bool clear = true;
      for (const Guard& guard : guards) clear = clear && guard.least(cubic) - error > guard.threshold();
      if (!clear && error > tolerance && level_ < deepest) continue;
      if (!clear) {
        const int passed = first_passed(phase, guards, cubic, step, 2 * tolerance);
        if (passed >= 0) return passed;
      }
      here = there;
      break;
    }
    sample_until(phase, ahead_.time);
    std::swap(state_, ahead_);
    for (Guard& guard : guards) guard.read(state_.time, here.value);
    if (level_ > 0) --level_;
  }
  return -1;
}

int BeamRun::deepest_level(const ModalPhase& phase) const {
  const double least = 1e-14 * std::max(state_.time, first_period_);
  return std::clamp(static_cast<int>(std::log2(phase.step(0) / least)), level_, ModalPhase::levels - 1);
}

int BeamRun::first_passed(ModalPhase& phase, const std::array<Guard, 2>& guards, const Cubic& cubic, double step,
                          double tolerance) {
  int first = -1;
  double earliest = step;
  for (int i = 0; i < 2; ++i) {
    const Guard& guard = guards[static_cast<std::size_t>(i)];
    const auto beyond = guard.passed_by(cubic, tolerance);
    if (!beyond) continue;
    const double level = guard.threshold();
    const auto margin = [&](double tau) {
      const Reading reading = phase.read_at(state_, state_.time + tau);
      return std::pair{guard.margin(reading.value) - level, guard.inside * reading.slope};
    };
    const double tau = guard.margin(cubic.start) <= level ? 0 : falling_root(margin, 0, *beyond * step);
    if (first < 0 || tau < earliest) {
      first = i;
      earliest = tau;
    }
  }
  if (first >= 0) {
    sample_until(phase, state_.time + earliest);
    phase.move(state_, state_.time + earliest);
  }
  return first;
}

}  // namespace ricochet::event_driven

/// \file
/// The motion as it is read on the grid.
namespace ricochet::event_driven {

BeamRun::Shapes::Shapes(const BeamModes& modes, const std::vector<double>& places)
    : value(static_cast<Eigen::Index>(places.size()), modes.count()), curvature(value) {
  for (Eigen::Index i = 0; i < value.rows(); ++i)
    for (int m = 0; m < modes.count(); ++m) {
      value(i, m) = modes.value(m, places[static_cast<std::size_t>(i)]);
      curvature(i, m) = modes.curvature(m, places[static_cast<std::size_t>(i)]);
    }
}

void BeamRun::reserve() {
  const std::size_t times = grid_.times.size(), fields = times * grid_.places.size();
  for (auto* curve : {&out_.tip, &out_.tip_velocity, &out_.energy, &out_.impulse}) curve->reserve(times);
  for (auto* field : {&out_.displacement, &out_.strain, &out_.velocity}) field->reserve(fields);
  field_.resize(static_cast<Eigen::Index>(grid_.places.size()));
}

double BeamRun::modal_energy(const ModalPhase& phase) const {
  return 0.5 * beam_.density * (b_.square().sum() + (phase.oscillators().stiffness() * a_.square()).sum());
}

void BeamRun::sample_until(ModalPhase& phase, double t) {
  for (; next_ < grid_.times.size() && grid_.times[next_] <= t; ++next_) {
    const double now = grid_.times[next_];
    phase.whole(state_, now, a_, b_);
    double energy = modal_energy(phase);
    if (side_ == 0) {
      // Until the first impact, modes left out keep their energy where nothing but η damps them.
      if (beam_.alpha == 0 && out_.events.empty()) energy += left_out_ * std::exp(-beam_.eta * now);
      out_.tip.push_back((beam_.free.end_value * a_).sum() + beam_.support.at(now));
      out_.tip_velocity.push_back((beam_.free.end_value * b_).sum() + beam_.support.rate(now));
      out_.impulse.push_back(impulse_);
    } else {
      const double r = lift(now), rate = lift_rate(now);
      energy += 0.5 * beam_.density *
                (rate * (rate * beam_.lift_square() + 2 * (beam_.lift_pinned * b_).sum()) +
                 3 * beam_.k2 * r * r / std::pow(beam_.length, 3));
      out_.tip.push_back(stop());
      out_.tip_velocity.push_back(0);
      out_.impulse.push_back(impulse_ + contact_impulse(now));
    }
    out_.energy.push_back(energy);
    sample_fields(side_ == 0 ? flight_shapes_ : contact_shapes_, now);
  }
}

void BeamRun::sample_fields(const Shapes& shapes, double t) {
  const auto append = [&](std::vector<double>& field, const Eigen::MatrixXd& rows, const Eigen::ArrayXd& modes,
                          double support, double lifted, auto&& lift_shape) {
    field_.noalias() = rows * modes.matrix();
    for (Eigen::Index i = 0; i < field_.size(); ++i)
      field.push_back(support + field_(i) +
                      (side_ == 0 ? 0 : lifted * lift_shape(grid_.places[static_cast<std::size_t>(i)])));
  };
  const auto shape = [&](double x) { return beam_.lift(x); };
  const auto bend = [&](double x) { return beam_.lift_curvature(x); };
  append(out_.displacement, shapes.value, a_, beam_.support.at(t), lift(t), shape);
  append(out_.strain, shapes.curvature, a_, 0, lift(t), bend);
  append(out_.velocity, shapes.value, b_, beam_.support.rate(t), lift_rate(t), shape);
}

void BeamRun::sample_start(const PanelSeries& displacement) {
  const Support& support = beam_.support;
  const auto square = [](double value) { return value * value; };
  const auto kinetic = [&](double x) { return square(problem_.velocity(x) - support.rate(0)); };
  const auto elastic = [&](double x) { return beam_.k2 * square(displacement.curvature(x)); };
  initial_energy_ =
      0.5 * beam_.density *
      (PanelSeries::integral(kinetic, beam_.length, panels) + PanelSeries::integral(elastic, beam_.length, panels));
  left_out_ = std::max(0.0, initial_energy_ - modal_energy(flight_));
  for (; next_ < grid_.times.size() && grid_.times[next_] <= 0; ++next_) {
    out_.tip.push_back(problem_.displacement(beam_.length));
    out_.tip_velocity.push_back(problem_.velocity(beam_.length));
    out_.energy.push_back(initial_energy_);
    out_.impulse.push_back(0);
    for (const double x : grid_.places) {
      out_.displacement.push_back(problem_.displacement(x));
      out_.strain.push_back(displacement.curvature(x));
      out_.velocity.push_back(problem_.velocity(x));
    }
  }
}

}  // namespace ricochet::event_driven
