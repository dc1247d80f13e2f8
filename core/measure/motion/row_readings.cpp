#include <ricochet/measure/motion/row_readings.hpp>

namespace ricochet {
RowReadings::RowReadings(const Marcher& marcher, const ObservedRows& rows)
    : RowReadings(*marcher.program().model, marcher.program().model->in_model(rows.rows), rows.on_support,
                  rows.on_motions) {}

RowReadings RowReadings::of_stops(const Marcher& marcher) {
  const MarchModel& model = *marcher.program().model;
  const SemiDiscrete& problem = model.problem();
  return {model, model.contact(), Eigen::VectorXd::Ones(problem.points()), problem.motions.at_points};
}

double RowReadings::lift(const Marcher& marcher, int row, double t) const {
  const SupportMotions& motions = marcher.motions();
  double sum = on_support_[row] == 0 ? 0.0 : on_support_[row] * marcher.support(0, t);
  if (!motions.empty()) sum += motions.sum(on_motions_.row(row), t, false);
  return sum;
}

double RowReadings::velocity(const Marcher& marcher, const EnergyAudit& audit, int row) const {
  const double t = marcher.time(), lasts = audit.last_duration(0);
  const double way = audit.last_way(marcher, rows_, row, 0) + lift(marcher, row, t) - lift(marcher, row, t - lasts);
  return way / lasts;
}

}  // namespace ricochet
