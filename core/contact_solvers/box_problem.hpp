#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <ricochet/contract/contact_law.hpp>
#include <vector>

namespace ricochet {

namespace box {

// What the sources of BoxSolver measure distances to bounds with.

/// Round-off of a measure with k active points, relative to its terms.
inline double round_off(int k) {
  return 16 * (k + 1) * std::numeric_limits<double>::epsilon();
}

/// > 0 beyond.
inline double beyond_bounds(double y, double lower, double upper) {
  return std::max(lower - y, y - upper);
}

/// The terms of (2) that a point with the effort p adds to those without.
inline double complementarity(double y, double lower, double upper, double p, double diagonal) {
  return p > 0 ? std::min(diagonal * p, y - lower) : std::min(-diagonal * p, upper - y);
}

}  // namespace box

class HeldBand;

/// An interior point of a box problem of many points, for the set that it shows. With a, b ≥ 0 the efforts of the lower
/// and the upper stop, p = a − b,
///
///     y = y° + A p,   s = y − lower,   t = upper − y,   a s = b t = μ → 0                                         (1)
///
/// by Newton with Mehrotra's predictor and corrector (1992), s and t from any start. Each iteration holds all points,
///
///     (A + D⁻¹) Δp = D⁻¹ e,     D = a/s + b/t                                                                      (2)
///
/// once, and solves twice: some twenty iterations whatever the set and wherever one starts. Bounds may be ±∞.
class BoxInterior {
 public:
  struct Problem {
    double reach = 0;
    Strided<const double> compliance;  ///< A = reach·W + diag(compliance)
    double depth = 0;                  ///< deepest violation of y°, > 0
    int points = 0;
    const double *free = nullptr, *lower = nullptr, *upper = nullptr;
  };

  /// Ends when the mean of a s and b t is 1e-12 of what it was, when no step is left, or after 60 iterations. Returns
  /// how many it made. Allocates when there are more points than ever before.
  int solve(HeldBand& band, const Problem& problem);
  /// +1: the point lies on its lower stop, −1: on its upper one, 0: on none; by which of a A_ii and s is larger.
  int side(int point) const { return side_[static_cast<std::size_t>(point)]; }

 private:
  /// One of the two stops of a point: its gap and its effort, what Newton changes of them.
  struct Stop {
    double gap = 0, effort = 0, gap_step = 0, effort_step = 0;
    double wanted = 0;  // change of the effort while the gap stays
    bool present() const { return effort > 0; }
    double weight() const { return effort > 0 ? effort / gap : 0; }
  };
  void start(HeldBand& band, const Problem& problem);
  void measure(HeldBand& band, const Problem& problem);
  void hold(HeldBand& band, const Problem& problem);
  void find_step(HeldBand& band, const Problem& problem, double target, bool correct);
  double length() const;
  double mean_work(double step) const;
  void move(double step);
  void show(HeldBand& band, const Problem& problem);

  std::vector<Stop> lower_, upper_;
  std::vector<double> measure_, effort_, compliance_, right_, step_, moved_;
  std::vector<signed char> side_;
};

class HeldBand;

/// The two-sided box problem of one lane
///
///     y = y° + A p,   A = reach·W + diag(compliance),      lower ≤ y ⊥ p ≤ upper:
///     p_i > 0 only where y_i = lower_i,  p_i < 0 only where y_i = upper_i,  else p_i = 0                          (1)
///
/// with W (m × m) symmetric positive semidefinite, read by columns on demand. Bounds may be ±∞; lower_i ≤ upper_i.
/// It is the optimality of min ½pᵀA p + y°ᵀp − Σ(lower_i p_i⁺ − upper_i p_i⁻), convex.
///
/// One active candidate: closed form. Otherwise a primal–dual active set (Hintermüller, Ito, Kunisch 2002),
/// warm-started from the sign of p. A point belongs to a stop when its measure without its own effort, y_i − A_ii p_i,
/// lies beyond it. This is where the diagonal scales. A set met again hands over to descent (Lawson and Hanson 1974,
/// NNLS, with two sides). The deepest violation enters (least index on ties), and the effort moves towards the solution
/// on the set. A point whose effort would change sign leaves. The sum above decreases strictly between sets, so none
/// returns: finite, for semidefinite W as well. (Murty's least index is finite too, but exponential where it matters:
/// over 10⁵ pivots for 50 nodes of a cantilever, against about a hundred.)
///
/// Only the columns of sets that were tried are asked for. Cost: O(m) to read the lane, and O(k³ + m·k) for each set of
/// k points. A set of more than `many` points is held in the band of its operator (a BandDelassus). The residual of W
/// itself corrects p until it is round-off. That costs O(n), n the size of the band, and no columns. A search over such
/// sets that comes back to one goes on from the set that an interior point shows (box_interior.cpp) before it descends.
///
/// **Uniqueness.** y is unique. The efforts p are computed from scratch from the final set. The warm start changes them
/// by round-off only, as long as W is regular on that set. Where it is not, one of the solutions is given: efforts on a
/// subset of independent points, the others zero. Examples are two points at one place, or more supports than a rigid
/// body needs. A point depends on others when its pivot is below 16(k+1)ε of its diagonal. A point with A_ii = 0 cannot
/// be moved and carries no effort.
///
/// **Tolerance.** All tests are relative to the lane's own data, so scaling y or A changes nothing. Convergence means a
/// residual (2) of at most 10⁻¹² d + 64(k+1)ε s. Here d is the deepest violation of y°. The size s is the largest
/// of y°, of the bounds in force and of the terms of A p. Signs of p are exact.
class BoxSolver {
 public:
  /// Sets of more points are held in the band, where there is one.
  static constexpr int many = 128;

  BoxSolver() = default;
  /// Reserves for m points; solve() allocates nothing after this, but for the interior point when it is first needed.
  void prepare(int points);

  /// y°, lower, upper, p: m numbers each, `stride` apart. compliance: one number for all points (m/N), 0 for rigid.
  /// On return p solves (1) with the residual said in the outcome, in units of y,
  ///     max_i max( lower_i − y_i, y_i − upper_i, min(A_ii p_i⁺, y_i − lower_i), min(A_ii p_i⁻, upper_i − y_i) ) (2)
  /// and the number of sets tried. Not converged (no solution, or descent ran out of sets): p holds the best iterate
  /// and outcome.converged is false. Data that are not finite (infinite bounds are) give p = 0 and an infinite
  /// residual. The result depends on this lane's numbers only, bit for bit, whatever the stride.
  LaneOutcome solve(DelassusColumns& W, double reach, double compliance, const double* free, const double* lower,
                    const double* upper, double* p, int points, int stride = 1) {
    return solve(W, reach, Strided<const double>{&compliance, 0}, free, lower, upper, p, points, stride);
  }
  /// The same of one lane of a stage.
  LaneOutcome solve(const LaneProblem& lane, double compliance) {
    return solve(lane, Strided<const double>{&compliance, 0});
  }
  /// The same with a compliance for each point.
  LaneOutcome solve(DelassusColumns& W, double reach, Strided<const double> compliance, const double* free,
                    const double* lower, const double* upper, double* p, int points, int stride = 1);
  LaneOutcome solve(const LaneProblem& lane, Strided<const double> compliance) {
    return solve(*lane.delassus, lane.reach, compliance, lane.free.first, lane.lower.first, lane.upper.first,
                 lane.effort.first, lane.points, lane.free.stride);
  }

  /// Largest number of sets that descent tries before it gives up (default, or negative: 50·m + 200).
  void limit_descent(int sets) { set_limit_ = sets; }

 private:
  enum class Side : signed char { upper = -1, none = 0, lower = 1, immobile = 2 };
  struct Operator {
    DelassusColumns& columns;
    double reach;
    Strided<const double> compliance;  // of each point
  };

  LaneOutcome solve_alone(const Operator& A, double free, double lower, double upper, double& p) const;
  LaneOutcome solve_uncoupled(Strided<const double> compliances);
  bool try_alone(const Operator& A, LaneOutcome& outcome);
  LaneOutcome search(const Operator& A, const double* previous, int stride);
  bool read(const double* free, const double* lower, const double* upper, int points, int stride);
  void choose_first_set(const double* previous, int stride);

  // box_set.cpp
  void try_set(const Operator& A);
  void factorise(const Operator& A);
  void substitute();
  void evaluate(const Operator& A);
  void judge();
  Side beyond(int i) const;
  double residual() const;
  double tolerance() const;

  // box_set.cpp
  HeldBand* band_for(const Operator& A) const;
  void try_held(const Operator& A, HeldBand& band);
  void find_null();
  bool look_inside(const Operator& A, LaneOutcome& outcome);

  // box_interior.cpp
  void descend(const Operator& A, LaneOutcome& outcome);
  bool slide(int entering);
  int first_to_leave(double& step) const;
  int deepest() const;
  void keep_best();

  double bound(int i) const { return side_[i] == Side::lower ? lower_[i] : upper_[i]; }
  bool active(int i) const { return side_[i] == Side::lower || side_[i] == Side::upper; }
  bool pulls(int i) const { return side_[i] == Side::lower ? effort_[i] < 0 : effort_[i] > 0; }
  bool all_right() const;
  int wrong_points() const;
  void move_all();
  bool seen_before();

  int set_limit_ = -1;
  int points_ = 0;    // m
  int count_ = 0;     // k, points in the set
  int known_ = 0;     // rows of the factor that hold for this operator
  int dropped_ = -1;  // a point that depends on the first `rank_` of the set, and its side
  int rank_ = 0;
  Side dropped_side_ = Side::none;
  int violated_ = 0, first_ = 0;  // by y°: how many, and one of them
  double depth_ = 0, size_ = 0;   // deepest violation of y°, and its size
  double terms_ = 0;              // size of the terms of A p
  double worst_ = 0, spill_ = 0;  // farthest beyond a bound, and beyond it and round-off
  double best_residual_ = 0;      // of best_
  std::vector<double> free_, lower_, upper_, measure_, effort_, feasible_, best_;  // m
  std::vector<double> diagonal_, pivot_, right_, null_;                            // k; right_ and null_: m
  std::unique_ptr<double[]> factor_;       // k rows of m: what no set needs is never written
  HeldBand* held_ = nullptr;               // that holds the last set tried; null: factor_ does
  std::vector<double> compliance_, step_;  // m, of a held set
  BoxInterior interior_;
  std::vector<const double*> column_;  // k
  std::vector<int> set_;               // k, increasing
  std::vector<Side> side_;             // m
  std::vector<std::uint64_t> visited_;
};

}  // namespace ricochet
