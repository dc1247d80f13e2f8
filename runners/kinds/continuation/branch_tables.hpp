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

/// The rows of a branch at corners whose states were kept, special points among them.
std::vector<BranchRow> rows_of(PeriodicMap& map, const FollowedBranch& branch, int multipliers);
std::vector<SpecialRow> special_rows_of(PeriodicMap& map, const FollowedBranch& branch);
/// Three prominences a decade, 1e-6 … 1e-2 of the scale.
std::vector<TurnRow> turn_rows_of(const FollowedBranch& branch, double scale);

}  // namespace ricochet
