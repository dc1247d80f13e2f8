#include <ricochet/measure/motion/row_readings.hpp>

namespace ricochet {
namespace {

// Rows of nodal displacements in the coordinates of a march.
RowMatrix in_model(const MarchModel& model, const SparseRows& rows) {
  if (!model.modal()) return RowMatrix::from(rows);
  RowMatrix out;
  Eigen::VectorXd nodal(rows.cols()), modal(model.rows());
  for (int i = 0; i < rows.rows(); ++i) {
    nodal = rows.row(i).transpose();
    // Φᵀ of a row is what loads take.
    model.load_to_model(nodal.data(), modal.data());
    for (int j = 0; j < model.rows(); ++j) {
      out.index.push_back(j);
      out.value.push_back(modal[j]);
    }
    out.start.push_back(static_cast<int>(out.index.size()));
  }
  return out;
}

}  // namespace

RowReadings::RowReadings(const Marcher& marcher, const ObservedRows& rows)
    : RowReadings(*marcher.program().model, in_model(*marcher.program().model, rows.rows), rows.on_support,
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
