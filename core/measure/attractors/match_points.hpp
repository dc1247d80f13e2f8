#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <ricochet/contract/worded.hpp>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <vector>

/// \file
/// Special points of branches (folds, first contacts, …) found again in other cases.
namespace ricochet {

/// A special point of one case.
struct CasePoint {
  std::size_t owner = 0;    ///< the case
  int branch = 0;           ///< of the case
  std::string family;       ///< points of two are never one: the kind, and the period and symmetry of the orbit
  double parameter = 0;     ///< in the unit of the parameter
  double half = 0;          ///< half the width of its interval
  double displacement = 0;  ///< of the tip at the strobe, m
  double arc = 0;           ///< along the branch from its start, m
  double prominence = 0;    ///< of a fold: how far the parameter goes back; 0: not known
  bool turns = false;       ///< whether the parameter goes back there, as λ − λ_f ∝ (u − u_f)²
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
  /// Of each point given: the place of its name, from 0 by family, parameter and displacement; −1 of a point that no
  /// finer case confirms.
  std::vector<int> name;
  int names = 0;
  /// Of each point given that has a name: how many points of its family in its case share its place, itself counted.
  std::vector<int> sharing;
};

/// Names special points over cases, by the links of all cases (one for each owner).
///
/// The distance of two points of a family is |Δλ|/Λ + |Δu|/U + |Δs|/(10 S), |Δλ| less what both intervals explain. Arcs
/// count a tenth, because folds that a step invents lengthen them. Where the parameter turns, |Δu|/U is less what its
/// interval leaves of u, √((|Δλ| + both half intervals)/Λ). Folds whose prominences differ by more than a factor
/// of 3 are no pair. Points of linked cases are paired one to one, nearest first, up to 0.05. The bound may be narrower
/// along a refinement. The next coarser pairs that are told from others give it: no other point is less than three
/// times as far. It is four times the largest distance of such pairs of the family, 0.001 at least. A point that its
/// finer case lacks is sought in the next case towards the reference. What two branches of a case share counts once.
///
/// Points that are joined over cases have a name under two conditions. The two finest cases of a refinement both have
/// them, and no other point is less than three times as far from either. The result depends on neither the order of
/// cases nor that of points. Throws std::invalid_argument where a link or an owner names no case, or links form a
/// circle.
MatchedPoints match_points(const std::vector<CasePoint>& points, const std::vector<CaseLink>& links,
                           const PointScales& scales);

/// A range of the parameter that branches of one kind of orbit cover in a case.
struct BranchReach {
  double from = 0, to = 0;
};

/// Whether a case has a point.
enum class PointPresence {
  found,
  many,        ///< other points of the family share its place
  absent,      ///< a branch passed its place without it
  not_reached  ///< no branch of the case came to its place
};
constexpr std::array<const char*, 4> words_of(PointPresence) {
  return {"found", "many", "absent", "not reached"};
}

/// Presence of a point at `parameter` in a case that has `sharing` points at its place (0: none), with branches that
/// cover `reaches`. A branch passed it where its range goes beyond the point by more than `margin` on both sides.
/// `passed`, if not null, is set to the widest range that did.
PointPresence presence_of(double parameter, double margin, int sharing, const std::vector<BranchReach>& reaches,
                          std::optional<BranchReach>* passed = nullptr);

// Orders and limits of a special point of a branch (a fold, a first contact, …) as a step, a mesh or a stiffness is
// refined. Differences of successive refinements take the place of errors, so that no reference is needed.

/// A special point at one size of a refinement.
struct PointLevel {
  double size = 0;   ///< the step, 1/N of a mesh, or 1/κ of a stiffness; > 0
  double value = 0;  ///< the parameter at the point
  double half = 0;   ///< half the width of its interval, in the unit of the value, ≥ 0
};

/// The order p of v(h) = v + c hᵖ.
struct PointOrder {
  std::optional<double> order, low, high;  ///< p and where it may be; absent where too few differences count
  std::size_t used = 0;                    ///< sizes whose differences count
  bool told = false;                       ///< the interval is no wider than ±0.5 and lies above 0.3
  std::string reason;                      ///< one sentence: which sizes, or why it is not told
};

/// The order of a point over the sizes of one refinement, in any order, one level of each.
///
/// The difference v_{k+1} − v_k of successive sizes counts where it is more than twice the widths of both intervals.
/// Used is the longest run of such differences of one sign that reaches the finest of them. Two differences (three
/// sizes) solve (h₂ᵖ − h₃ᵖ)/(h₁ᵖ − h₂ᵖ) = d₂/d₁. The interval of p follows from the intervals of the points, taken as
/// 2 % of a difference at least. From three on, |d_k|/(1 − (h_{k+1}/h_k)ᵖ) = |c| h_kᵖ is fitted by fit_order(), as
/// errors of a convergence study are. The p on the left is the one that comes out. Throws std::invalid_argument on a
/// size that is not positive or a negative interval.
PointOrder point_order(std::vector<PointLevel> levels);

/// Where a point goes along one refinement.
struct PointLimit {
  double value = 0;            ///< where the limit is expected
  double correction = 0;       ///< of the finest value: value − v_n
  std::optional<double> open;  ///< what the refinement leaves open, in the unit of the value; nothing of one size
  LimitStatus status = LimitStatus::one;  ///< of the values as they are
};

/// The limit along one refinement. With an order that is told it is v_n + (v_n − v_{n−1})/((h_{n−1}/h_n)ᵖ − 1), and
/// that correction is open; of an order that three sizes tell, (v_n − v_{n−1})/(h_{n−1}/h_n − 1), which holds any order
/// above one. Otherwise the finest value, with the uncertainty of limit_of(). Levels as for
/// point_order(); at least one, else std::invalid_argument.
PointLimit point_limit(std::vector<PointLevel> levels, const PointOrder& order);

}  // namespace ricochet
