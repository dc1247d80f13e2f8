#include <algorithm>
#include <cmath>

#include "beam_run.hpp"

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
