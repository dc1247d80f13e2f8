#include "runners/kinds/trajectory/force_window.hpp"

#include <algorithm>
#include <cmath>
#include <ricochet/engine/flight/step_interval.hpp>

namespace ricochet {

ForceWindow::ForceWindow(const Json& settings, const Marcher& marcher) {
  // Of steps with several instants each has a weight of its own: they are all seen.
  if (marcher.program().flight && marcher.program().stages.size() == 1) asks_.next_shown = never;
  if (!has_window(settings)) return;
  from_ = settings.at("window").at("from").get<double>();
  to_ = settings.at("window").at("to").get<double>();
}

void ForceWindow::stage_solved(const Marcher& marcher, const StageView& view) {
  if (!view.effort) return;
  const StageProgram& program = *view.program;
  if (program.opens_instant) given_ = lasts_ = 0;
  lasts_ = std::max(lasts_, program.momentum);
  if (view.contact_lanes & 1u)
    for (int j = 0; j < marcher.program().model->problem().points(); ++j)
      given_ += program.momentum * view.effort[0][j * marcher.width()];
  const double t = view.time + program.facts.instant * marcher.program().h;
  if (!program.closes_instant || !(lasts_ > 0) || t < from_ || t > to_) return;
  add(given_ / lasts_, lasts_);
}

// Welford's sums: no difference of large squares.
void ForceWindow::add(double force, double lasts) {
  weight_ += lasts;
  const double apart = force - mean_;
  mean_ += lasts / weight_ * apart;
  squares_ += lasts * apart * (force - mean_);
}

void ForceWindow::interval(Marcher& marcher, const StepInterval& steps) {
  const StageProgram& program = marcher.program().stages.front();
  const double h = marcher.program().h, lasts = program.momentum, first = steps.from + program.facts.instant * h;
  if (!(lasts > 0) || !program.reads_contact) return;
  if (!steps.closed.empty()) {
    long long step = 0;
    steps.each_stage([&](int, std::span<const double> efforts, std::span<const double>) {
      const double t = first + static_cast<double>(step++) * h;
      double force = 0;
      for (const double p : efforts) force += p;
      if (t >= from_ && t <= to_) add(force, lasts);
    });
    return;
  }
  // Instants without a force, in one: they have no spread of their own.
  const double last = first + static_cast<double>(steps.steps - 1) * h;
  // A step is at a bound of the window up to the rounding of two times.
  constexpr double rounding = 1e-6;
  const double begin = std::ceil((std::max(from_, first) - first) / h - rounding);
  const double end = std::floor((std::min(to_, last) - first) / h + rounding);
  if (end >= begin) add(0, (end - begin + 1) * lasts);
}

double ForceWindow::deviation() const {
  return std::sqrt(squares_ / weight_);
}

}  // namespace ricochet
