#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Special points of branches (folds, first contacts, …) found again in other cases.
namespace ricochet {

/// A special point of one case.
struct CasePoint {
  std::size_t owner = 0;  ///< the case
  int branch = 0;         ///< of the case
  std::string kind;      ///< points of different kinds are never one; the period and symmetry of the orbit belong to it
  double parameter = 0;  ///< in the unit of the parameter
  double half = 0;       ///< half the width of its interval
  double displacement = 0;  ///< of the tip at the strobe, m
  double arc = 0;           ///< along the branch from its start, m
  double prominence = 0;    ///< of a fold: how far the parameter goes back; 0: not known
};

/// What distances between points are measured by, > 0.
struct PointScales {
  double parameter = 1, displacement = 1, arc = 1;
};

/// The case that a case is compared with: one step finer along one axis, or the reference method. The links of a study
/// form a tree, whose root is the reference case.
struct CaseLink {
  std::optional<std::size_t> to;  ///< nothing of the root
  std::string along;              ///< the axis in which the two differ
  bool refined = false;           ///< the axis is a refinement: a step, a mesh, a stiffness
};

/// What became of the points.
struct MatchedPoints {
  /// Of each point given: the place of its name, from 0 by kind, parameter and displacement; −1 of a point that no
  /// finer case confirms.
  std::vector<int> name;
  int names = 0;
  /// Of each point given that has a name: how many points of its kind in its case share its place, itself counted.
  std::vector<int> sharing;
};

/// Names special points over cases, by the links of all cases (one for each owner).
///
/// The distance of two points of a kind is |Δλ|/Λ + |Δu|/U + |Δs|/(10 S), |Δλ| less what both intervals explain: arcs
/// count a tenth, because folds that a step invents lengthen them. Folds whose prominences differ by more than a factor
/// of 3 are no pair. Points of linked cases are paired one to one,
/// nearest first, up to 0.05. Along a refinement whose next coarser pairs are told from others (no other point less
/// than three times as far) the bound is four times the largest of their distances, 0.001 at least. A point that its
/// finer case lacks is sought in the next case towards the reference. What two branches of a case share counts once.
///
/// Points that are joined over cases have a name where the two finest cases of a refinement both have them and no other
/// point is less than three times as far from either. The result
/// depends on neither the order of cases nor that of points. Throws std::invalid_argument where a link or an owner
/// names no case, or links form a circle.
MatchedPoints match_points(const std::vector<CasePoint>& points, const std::vector<CaseLink>& links,
                           const PointScales& scales);

/// A range of the parameter that branches of one kind of orbit cover in a case.
struct BranchReach {
  double from = 0, to = 0;
};

/// Whether a case has a point.
enum class PointPresence {
  found,
  many,        ///< other points of the kind share its place
  absent,      ///< a branch passed its place without it
  not_reached  ///< no branch of the case came to its place
};
/// "found", "many", "absent", "not reached".
const char* word(PointPresence presence);

/// Presence of a point at `parameter` in a case that has `sharing` points at its place (0: none), with branches
/// that cover `reaches`. A branch passed it where its range goes beyond the point by more than `margin` on both sides;
/// `passed`, if not null, is set to the widest range that did.
PointPresence presence_of(double parameter, double margin, int sharing, const std::vector<BranchReach>& reaches,
                          std::optional<BranchReach>* passed = nullptr);

}  // namespace ricochet
