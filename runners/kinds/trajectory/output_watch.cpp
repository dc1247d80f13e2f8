#include "runners/kinds/trajectory/output_watch.hpp"

#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/flight.hpp>

namespace ricochet {
namespace {

int place_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

// Times that are equal but for their rounding.
constexpr double rounding = 1e-6;

}  // namespace

SpectrumTaker::SpectrumTaker(const Marcher& marcher, const AskedOutputs& asked, const AskedSpectrum& of)
    : of_(of),
      window_(asked.window),
      rate_(asked.rate),
      stops_(marcher),
      points_(marcher, marcher.program().problem->observed),
      stop_(place_of(stop_list(*marcher.program().problem).names, of.of)),
      point_(stop_ < 0 ? place_of(marcher.program().problem->observed.names, of.of) : -1),
      spectrum_(asked.rate, asked.segment_samples()),
      last_(static_cast<long long>(std::floor((window_.to - window_.from) * rate_ + rounding))) {
  const Eigen::VectorXd start = marcher.program().model->to_model(marcher.program().lanes.front().position);
  value_ = place(marcher, start.data(), 0);
  // A step or two may be under way while a sample waits.
  if (of_.force) bins_.resize(8 + static_cast<std::size_t>(std::ceil(4 * rate_ * marcher.program().h)));
}

double SpectrumTaker::place(const Marcher& marcher, const double* position, double t) const {
  if (stop_ >= 0) return stops_.displacement(marcher, stop_, position, t);
  return points_.relative(point_, position) + points_.lift(marcher, point_, t);
}

void SpectrumTaker::see(const Marcher& marcher) {
  const double t = marcher.time(), h = marcher.program().h;
  if (of_.force) return flush(t - 2 * h);
  if (t < window_.from - 2 * h || next_ > last_) return;
  const double value = place(marcher, marcher.slot(0), t);
  for (; next_ <= last_; ++next_) {
    const double at = window_.from + static_cast<double>(next_) / rate_;
    if (at > t + rounding * h) break;
    spectrum_.add(value_ + (at - before_) / (t - before_) * (value - value_));
  }
  before_ = t;
  value_ = value;
}

void SpectrumTaker::instant(const ContactInstant& one) {
  if (!of_.force || one.point != stop_) return;
  const double at = (one.time - window_.from) * rate_ + rounding;
  if (at < 0 || at >= static_cast<double>(last_)) return;
  flush(one.time - (static_cast<double>(bins_.size()) - 2) / rate_);
  const auto bin = static_cast<std::size_t>(std::max(static_cast<long long>(at), next_)) % bins_.size();
  bins_[bin] += one.side == StopSide::lower ? one.given : -one.given;
}

// Samples that end before a time.
void SpectrumTaker::flush(double until) {
  for (; next_ < last_ && window_.from + static_cast<double>(next_ + 1) / rate_ <= until; ++next_) {
    double& bin = bins_[static_cast<std::size_t>(next_) % bins_.size()];
    spectrum_.add(bin * rate_);
    bin = 0;
  }
}

void SpectrumTaker::finish(double time) {
  if (of_.force) flush(time * (1 + 1e-9));
}

OutputWatch::OutputWatch(const StudyCase& study_case, const Marcher& marcher, StopContacts& contacts)
    : asked_(asked_outputs(study_case)) {
  const SemiDiscrete& problem = *marcher.program().problem;
  const bool contact = marcher.program().contact;
  if (contact && asked_.windowed && (asked_.any || !problem.stops.empty())) {
    statistics_.emplace(marcher, asked_.window);
    contacts.tell(&*statistics_);
    reads_steps_ = true;
  }
  if (contact && asked_.shocks) {
    shocks_.emplace(contacts.list().count(), *asked_.shocks, asked_.window);
    contacts.tell(&*shocks_);
  }
  spectra_.reserve(asked_.spectra.size());
  for (const AskedSpectrum& one : asked_.spectra) {
    spectra_.emplace_back(marcher, asked_, one);
    reads_steps_ = reads_steps_ || spectra_.back().reads_steps();
  }
  for (SpectrumTaker& one : spectra_) contacts.tell(&one);
  ask(marcher);
}

// Flights may leave out what is before and after the window.
void OutputWatch::ask(const Marcher& marcher) {
  const double h = marcher.program().h, t = marcher.time();
  asks_.next_shown = never;
  if (!reads_steps_ || t > asked_.window.to + 2 * h) return;
  const double left = std::floor((asked_.window.from - t) / h) - 2;
  asks_.next_shown = marcher.program().flight && left > 0 ? marcher.step() + 1 + static_cast<long long>(left) : 0;
}

void OutputWatch::step_done(Marcher& marcher) {
  if (marcher.status(0).running) {
    if (statistics_) statistics_->see(marcher);
    for (SpectrumTaker& one : spectra_) one.see(marcher);
  }
  ask(marcher);
}

void OutputWatch::interval(Marcher& marcher, const StepInterval&) {
  for (SpectrumTaker& one : spectra_)
    if (!one.reads_steps()) one.see(marcher);
  ask(marcher);
}

void OutputWatch::finish(const Marcher& marcher) {
  if (shocks_) shocks_->finish(marcher.time(), marcher.program().h);
  for (SpectrumTaker& one : spectra_) one.finish(marcher.time());
}

}  // namespace ricochet
