#pragma once
#include <ricochet/engine/compile.hpp>
#include <ricochet/engine/flight/step_rows.hpp>
#include <vector>

/// \file
/// What stands on the right of a step, over what drives it.
namespace ricochet {

/// Rows of H and the like as a dense matrix, rows × columns.
Eigen::MatrixXd dense(const RowMatrix& rows, int columns);

/// `factor` times a combination of levels of the clamp's motion, over e.
Eigen::RowVectorXd harmonic(const PhaseWeights& phase, const FlightDrive& drive, double factor = 1);

/// A load over e, in the coordinates of the march (rows × drives): of the clamp's inertia, and of a distributed load
/// that is constant in time.
Eigen::MatrixXd load_over_drive(const Program& program, const Levels& levels, const FlightDrive& drive);

/// The weight of slot j; trailing ones may be left out.
inline double weight_at(const std::vector<double>& weights, int j) {
  return static_cast<std::size_t>(j) < weights.size() ? weights[static_cast<std::size_t>(j)] : 0.0;
}

}  // namespace ricochet
