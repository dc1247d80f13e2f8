#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <ricochet/measure/orbits/branch.hpp>
#include <ricochet/measure/orbits/periodic_map.hpp>
#include <ricochet/measure/orbits/point_kind.hpp>
#include <ricochet/measure/orbits/stepped_map.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// A special point of a branch.
struct SpecialPoint {
  PointKind kind = PointKind::end;  ///< of a change of contact: contact
  long long corner = 0;
  double parameter = 0, low = 0, high = 0, arc = 0, tip = 0;
  std::optional<std::complex<double>> multiplier;
  int crossings = 0;  ///< raw ones of the group; 0: does not apply
  std::optional<double> prominence;
  std::string side;
  std::optional<SetChange> change;  ///< of a contact
  int runs_before = 0, runs_after = 0;
  int held_before = 0, held_after = 0;  ///< of these runs, those that never end
  TraceEnd ends = TraceEnd::none;       ///< of an end
  std::string note;
};

/// What is asked of special points.
struct PointSearch {
  bool half = false;
  double prominence = 0;  ///< least one of a fold, in units of λ
  bool by_steps = false;  ///< corners are orbits along a curve: what is between two of them is interpolated
  double gap = 0.1;       ///< m
  double contacts = 0;    ///< to which contacts are placed on corners, in units of λ; 0: they lie between corners
  double metres = 1;      ///< of one unit of λ (StateMetric)
  const BranchTrace* before = nullptr;  ///< from the first orbit the other way, where it was followed
};

/// Raw crossings this near along a branch are one group, by arc (of the gap), or by pieces up to a larger arc.
inline constexpr double group_arc = 0.03;
inline constexpr long long group_pieces = 40;
inline constexpr double group_pieces_arc = 0.1;
/// Between two crossings that cancel the count differs over at most so many corners, else both are points.
inline constexpr std::size_t few_corners = 4;
/// Steps of the shortest run of contact below which no multiplier is told.
inline constexpr int shortest_told = 4;

/// A turn of λ along a branch. On either side λ goes back by some way before it goes beyond the turn. The ends of a
/// branch and its first contacts cut ways off. The prominence is the smaller way that nothing cuts off; the larger one
/// where both are cut off.
struct Turn {
  long long corner = 0;
  double parameter = 0;
  double prominence = 0;
  double shortest = 0;  ///< the smaller way, cut off or not
};
/// Those of a trace. `before`: the branch from its first orbit the other way; ways go on along it.
std::vector<Turn> turns_of(const BranchTrace& trace, const BranchTrace* before = nullptr);
/// Share of the least prominence that a way which is cut off must have.
inline constexpr double cut_share = 0.1;

/// Special points of a branch, in its order, the end last:
///
///     fold      turns of λ; the interval is half a piece in λ
///     symmetry  (half map), flip (period map): a real multiplier through −1
///     torus     a pair through the circle
///     contact   a run of contact that appears or vanishes, or a permanent one that opens: known to round-off
///
/// A real multiplier passes −1 where ∏ (1 + μ) changes its sign. Crossings near to each other are one group; on a
/// branch by steps each is its own. A group is a point where the count of multipliers outside differs before and after
/// it. Its value is where the multiplier by the half-step rule crosses, or the middle frozen crossing where none does.
/// Its interval is all of the group. Where the count changes with a contact that comes or goes, the corner is the
/// point, and no multiplier is told. Contacts that change at once are one point; a branch that comes by a place again
/// has it once.
std::vector<SpecialPoint> special_points(const BranchTrace& trace, const PointSearch& search);

/// An orbit of another branch, near to the point at which it begins.
struct SwitchedOrbit {
  ShotOrbit orbit;
  MapClock clock;  ///< of the whole period where symmetry is lost, of the doubled one at a flip
};

/// Looks for the branch that begins where a multiplier of an orbit passes −1. With v its vector, Newton's method on the
/// doubled map starts from x ± a v. The amplitude a is a thousandth, three thousandths and a hundredth of `scale` (m).
/// The values lie one, two and four widths of the point's interval on either side of it. `x_at` solves the orbit of the
/// branch itself near to a value. An orbit is taken that the map itself does not return to within a millionth of the
/// scale. Nothing where there is none.
template <class Map>  // PeriodicMap or SteppedMap
std::optional<SwitchedOrbit> switch_branch(Map& map, const MapClock& clock, const SpecialPoint& point, double scale,
                                           double tolerance, const std::function<ShotOrbit(double parameter)>& x_at);

/// The derivative of a map at an orbit that was solved.
Eigen::MatrixXd derivative_at(PeriodicMap& map, const ShotOrbit& orbit, const MapClock& clock);
Eigen::MatrixXd derivative_at(SteppedMap& map, const ShotOrbit& orbit, const MapClock& clock);

}  // namespace ricochet
