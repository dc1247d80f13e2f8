#pragma once
#include <ricochet/measure/orbits/special_points.hpp>
#include <string>
#include <vector>

#include "runners/kinds/continuation/continuation_tables.hpp"

namespace ricochet {

/// A branch that was followed, and how its rows are made.
struct FollowedBranch {
  std::string name;
  MapClock clock;
  BranchTrace trace;
  std::vector<SpecialPoint> points;
  int iterations = 0;                                     ///< of its first orbit
  std::vector<std::pair<long long, std::string>> leaves;  ///< corner and name of branches that begin there
};

/// The row of one orbit, marched once more: tip, residual, penetration.
BranchRow orbit_row(PeriodicMap& map, const MapClock& clock, const Eigen::VectorXd& x, double parameter);

/// Folds below this share of the parameter's scale are not listed where the study names no prominence.
inline constexpr double least_fold = 1e-4;

/// The row of an orbit that was not found, and why.
SpecialRow missing_orbit(const std::string& name, double at, std::string why);

/// Rows at the corners whose states were kept, as the trace has them.
std::vector<BranchRow> corner_rows_of(const FollowedBranch& branch, int multipliers);
/// The rows of a branch at corners whose states were kept, special points among them.
std::vector<BranchRow> rows_of(PeriodicMap& map, const FollowedBranch& branch, int multipliers);
/// `x_of_rows`: where the point of each row of v stands, m.
std::vector<SpecialRow> special_rows_of(const FollowedBranch& branch, const std::vector<double>& x_of_rows);
std::vector<double> x_of_rows(const PeriodicMap& map);
/// Three prominences a decade, 1e-6 … 1e-2 of the scale.
std::vector<TurnRow> turn_rows_of(const FollowedBranch& branch, double scale);

}  // namespace ricochet
