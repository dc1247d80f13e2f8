#pragma once
#include <optional>
#include <ricochet/measure/statistics/refinement.hpp>
#include <string>
#include <vector>

/// \file
/// Orders and limits of a special point of a branch (a fold, a first contact, …) as a step, a mesh or a stiffness is
/// refined. Differences of successive refinements take the place of errors, so that no reference is needed.
namespace ricochet {

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
/// sizes) solve (h₂ᵖ − h₃ᵖ)/(h₁ᵖ − h₂ᵖ) = d₂/d₁, and the interval is what the intervals of the points, 2 % of a
/// difference at least, make of p. From three on, |d_k|/(1 − (h_{k+1}/h_k)ᵖ) = |c| h_kᵖ is fitted as errors of a
/// convergence study are (fit_order()), p on the left being the one that comes out. Throws std::invalid_argument on a
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
/// that correction is open. Otherwise the finest value, with the uncertainty of limit_of(). Levels as for
/// point_order(); at least one, else std::invalid_argument.
PointLimit point_limit(std::vector<PointLevel> levels, const PointOrder& order);

}  // namespace ricochet
