#include "runners/kinds/trajectory/force_window.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

ForceWindow::ForceWindow(const Json& settings, StepObserver& behind) : behind_(behind) {
  if (!settings.is_object() || !settings.contains("window")) return;
  from_ = settings.at("window").at("from").get<double>();
  to_ = settings.at("window").at("to").get<double>();
}

void ForceWindow::stage_solved(const Marcher& marcher, const StageView& view) {
  behind_.stage_solved(marcher, view);
  if (!view.effort) return;
  const StageProgram& program = *view.program;
  if (program.opens_instant) given_ = lasts_ = 0;
  lasts_ = std::max(lasts_, program.momentum);
  if (view.contact_lanes & 1u)
    for (int j = 0; j < marcher.program().model->problem().points(); ++j)
      given_ += program.momentum * view.effort[0][j * marcher.width()];
  const double t = view.time + program.facts.instant * marcher.program().h;
  if (!program.closes_instant || !(lasts_ > 0) || t < from_ || t > to_) return;
  // Welford's sums: no difference of large squares.
  weight_ += lasts_;
  const double force = given_ / lasts_, apart = force - mean_;
  mean_ += lasts_ / weight_ * apart;
  squares_ += lasts_ * apart * (force - mean_);
}

double ForceWindow::deviation() const {
  return std::sqrt(squares_ / weight_);
}

}  // namespace ricochet
