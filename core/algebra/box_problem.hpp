#pragma once
#include <span>
#include <vector>

#include <ricochet/contract/contact_law.hpp>

namespace ricochet {

/// The two-sided box problem of one lane
///
///     y = y° + (reach·W + diag(compliance)) p,      lower ≤ y ⊥ p ≤ upper:
///     p_i > 0 only where y_i = lower_i,  p_i < 0 only where y_i = upper_i,  else p_i = 0                          (1)
///
/// with W (m × m) symmetric positive semidefinite, read by columns on demand. Bounds may be ±∞; lower_i ≤ upper_i.
/// One active candidate: closed form. Otherwise a primal–dual active set (Hintermüller, Ito, Kunisch 2002) warm-started
/// from the sign of p, scaled by the diagonal, which detects a repeated set and then falls back on principal pivoting by least index
/// (Murty 1974), finite for P-matrices. Only the columns of sets that were tried are asked for.
class BoxSolver {
 public:
  BoxSolver() = default;
  /// Reserves for m points; solve() allocates nothing after this.
  void prepare(int points);

  /// y°, lower, upper, p: m numbers each, `stride` apart. compliance: one number for all points (m/N), 0 for rigid.
  /// On return p solves (1) with the residual said in the outcome:
  ///     max_i max( lower_i − y_i, y_i − upper_i, min(p_i⁺/scale, y_i − lower_i), min(p_i⁻/scale, upper_i − y_i) ), in units of y.
  /// Not converged: p holds the best iterate, outcome.converged is false.
  LaneOutcome solve(DelassusColumns& W, double reach, double compliance, const double* free, const double* lower,
                    const double* upper, double* p, int points, int stride = 1);

  /// Largest number of pivots of the finite fallback before it gives up (default 50·m + 200).
  void limit_pivots(int pivots) { pivot_limit_ = pivots; }

 private:
  int pivot_limit_ = 0;
  std::vector<double> workspace_;   // sized by prepare()
  std::vector<int> indices_;
};

}  // namespace ricochet
