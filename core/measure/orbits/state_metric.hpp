#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <ricochet/engine/marcher.hpp>
#include <utility>
#include <vector>

/// \file
/// States of one lane as vectors of numbers, and how long these are.
namespace ricochet {

/// The state of one lane as numbers, and back.
class StateVector {
 public:
  explicit StateVector(const Program& program);
  int size() const { return static_cast<int>(slots_) + static_cast<int>(efforts_.size()) * points_; }
  Eigen::VectorXd read(const LaneState& state) const;
  /// What is not part of x stays as `state` has it.
  void write(const Eigen::VectorXd& x, LaneState& state) const;

 private:
  std::size_t slots_ = 0;
  std::vector<std::ptrdiff_t> efforts_;  // where p₋₁, p₋₂, … stand in LaneState::efforts; −1: no such effort
  int points_ = 0;
};

/// What a metre of arclength is.
struct ArcUnits {
  double parameter = 1;  ///< metres per unit of λ
  double pulsation = 1;  ///< ω of the forcing, rad/s: a velocity v counts as v/ω
};

/// How long states are, m: the root mean square over nodal displacements, or the tip's where the state is in modes.
/// Velocities count over ω, accelerations over ω². All slots and the parameter times its scale in metres add in
/// squares.
class StateMetric {
 public:
  StateMetric(const Program& program, int state_size, const ArcUnits& units);
  StateMetric(Eigen::MatrixXd rows, double parameter_metres) : rows_(std::move(rows)), metres_(parameter_metres) {}
  double size(const Eigen::VectorXd& x, double parameter = 0) const;
  /// Weighted readings over x: size² = |rows x|² + (metres λ)².
  const Eigen::MatrixXd& rows() const { return rows_; }
  double parameter_metres() const { return metres_; }
  /// ω of the forcing, rad/s; 1 where the metric was given by its rows.
  double pulsation() const { return pulsation_; }
  /// The displacement of a state, root mean square over nodes, m, and its velocity, m/s. What slots hold of them is
  /// solved for in the mean: q and hv, or q of two steps. Zero where the metric was given by its rows.
  double displacement(const Eigen::VectorXd& x) const {
    return displacement_.rows() > 0 ? (displacement_ * x).norm() : 0;
  }
  double velocity(const Eigen::VectorXd& x) const { return velocity_.rows() > 0 ? (velocity_ * x).norm() : 0; }

 private:
  Eigen::MatrixXd rows_;                     // of all weighted readings over x
  Eigen::MatrixXd displacement_, velocity_;  // readings of each alone
  double metres_, pulsation_ = 1;
};

}  // namespace ricochet
