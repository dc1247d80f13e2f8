#pragma once
#include <optional>
#include <ricochet/measure/orbits/special_points.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <string>
#include <vector>

#include "runners/kinds/continuation/branch_orbits.hpp"
#include "runners/kinds/continuation/continuation_study.hpp"
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
  const FollowedBranch* other = nullptr;                  ///< the way back from its first orbit, where it was followed
  const BranchTrace* before() const { return other ? &other->trace : nullptr; }
};

/// Ends a branch at one of its special points.
void cut_at(BranchTrace& trace, const SpecialPoint& point);

/// The row of one orbit, marched once more: tip, residual, penetration.
BranchRow orbit_row(PeriodicMap& map, const MapClock& clock, const Eigen::VectorXd& x, double parameter);
BranchRow orbit_row(SteppedMap& map, const MapClock& clock, const Eigen::VectorXd& x, double parameter);

/// The first point of one of these kinds along a branch; no end of it.
std::optional<SpecialPoint> first_of(std::vector<SpecialPoint> points, const std::vector<PointKind>& kinds);

/// Folds below this share of the parameter's scale are not listed where the study names no prominence.
inline constexpr double least_fold = 1e-4;

/// Rows at the corners whose states were kept, as the trace has them.
std::vector<BranchRow> corner_rows_of(const FollowedBranch& branch, int multipliers);
/// The multipliers of an orbit, largest first, the first `most` of them, and how many are outside the circle.
void put_multipliers(const std::vector<std::complex<double>>& multipliers, const Outside& outside, int most,
                     BranchRow& row);
/// The rows of a branch at corners whose states were kept, special points among them.
template <class Map>
std::vector<BranchRow> rows_of(Map& map, const FollowedBranch& branch, int multipliers);
/// Where the point of each row of v stands, m.
std::vector<double> x_of_rows(const PeriodicMap& map);
std::vector<double> x_of_rows(const SteppedMap& map);

/// What the branches of a case come to, whichever way they are followed.
class BranchResults {
 public:
  /// A row of branches.csv alone.
  void add(BranchRow row) { rows_.push_back(std::move(row)); }
  /// A branch with its rows. `scale`: that of the parameter.
  void add(const FollowedBranch& branch, std::vector<BranchRow> rows, const std::vector<double>& x_of_rows,
           double scale);
  /// What is kept of its orbits beside: states and portraits (BranchOrbits).
  void keep_orbits(const FollowedBranch& branch, const std::vector<BranchRow>& rows, const MarchBranchOrbit& march,
                   std::size_t most_states) {
    orbits_.add(branch, rows, march, most_states);
  }
  /// An orbit that was not found is a row that says so, and fails its case.
  void add_missing(const std::string& name, double at, std::string why);
  /// Tables, measures, status and reason. `spent`: the budget, s, that was not enough.
  void put(CaseRecord& record, const ContinuationPlan& plan, long long pieces, std::optional<double> spent) const;

 private:
  std::vector<BranchRow> rows_;
  std::vector<SpecialRow> special_;
  std::vector<TurnRow> turns_;
  BranchOrbits orbits_;
  int branches_ = 0, found_ = 0;
  std::string missing_;  // why the first orbit that was not found was not
};

}  // namespace ricochet
