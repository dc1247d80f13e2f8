#pragma once
#include <array>
#include <ricochet/engine/marcher.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>
#include <string>
#include <vector>

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

/// The stops of a problem: contact points, of which a clearance has several, its sides.
struct StopList {
  std::vector<std::string> names;  ///< empty strings where stops have none
  std::vector<int> row;            ///< first contact point of each
  std::vector<int> clearance;      ///< number of its clearance, −1: none
  std::vector<int> stop_of;        ///< of each contact point

  int count() const { return static_cast<int>(row.size()); }
  bool round(int stop) const { return clearance[static_cast<std::size_t>(stop)] >= 0; }
};
StopList stop_list(const SemiDiscrete& problem);

/// What the bounds of each stop are put on, m: the displacement of its contact point. Of a clearance it is the distance
/// from its centre. Allocates when constructed.
class StopPlaces {
 public:
  explicit StopPlaces(const Marcher& marcher);

  int count() const { return static_cast<int>(stops_.size()); }
  /// At the end of the last step.
  double displacement(const Marcher& marcher, int stop) const {
    return displacement(marcher, stop, marcher.slot(0), marcher.time());
  }
  /// Of a position in the coordinates of the march.
  double displacement(const Marcher& marcher, int stop, const double* position, double t) const;
  /// u₁ and u₂ of a clearance at the end of the last step, less those of its centre, m; of another stop its
  /// displacement and 0.
  std::array<double, 2> components(const Marcher& marcher, int stop) const {
    return components(marcher, stop, marcher.slot(0), marcher.time());
  }
  /// Of a clearance, m.
  double radius(int stop) const { return stops_[static_cast<std::size_t>(stop)].radius; }

 private:
  // u₁ is row `first`, u₂ = (row `other` − cosine u₁)/sine, both less the centre.
  struct Stop {
    int first = 0, other = -1;
    double cosine = 0, sine = 1, radius = 0;
    std::array<double, 2> centre = {0, 0};
  };
  std::array<double, 2> components(const Marcher& marcher, int stop, const double* position, double t) const;

  RowReadings rows_;
  std::vector<Stop> stops_;
};

}  // namespace ricochet
