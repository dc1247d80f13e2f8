#pragma once
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

namespace ricochet {

/// Reads observed rows of a marching lane 0. Allocates when constructed.
class RowReadings {
 public:
  RowReadings(const Marcher& marcher, const ObservedRows& rows);
  /// The contact points of a marcher, as their stops see them: less what a stop moves by.
  static RowReadings of_stops(const Marcher& marcher);

  int count() const { return rows_.rows(); }
  /// What supports add to row i at a time, m.
  double lift(const Marcher& marcher, int row, double t) const;
  /// Row i of a position in the coordinates of the march, supports left out.
  double relative(int row, const double* position) const { return model_->times(rows_, row, position); }
  /// At the end of the last step, m.
  double displacement(const Marcher& marcher, int row) const {
    return relative(row, marcher.slot(0)) + lift(marcher, row, marcher.time());
  }
  /// The mean over the last sub-step, m/s; of the last step whose energies were asked for.
  double velocity(const Marcher& marcher, const EnergyAudit& audit, int row) const;

 private:
  RowReadings(const MarchModel& model, RowMatrix rows, Eigen::VectorXd on_support, Eigen::MatrixXd on_motions)
      : model_(&model),
        rows_(std::move(rows)),
        on_support_(std::move(on_support)),
        on_motions_(std::move(on_motions)) {}

  const MarchModel* model_;
  RowMatrix rows_;
  Eigen::VectorXd on_support_;
  Eigen::MatrixXd on_motions_;
};

}  // namespace ricochet
