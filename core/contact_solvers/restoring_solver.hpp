#pragma once
#include <ricochet/contract/contact_law.hpp>
#include <vector>

namespace ricochet {

/// The efforts of one lane that give back a known work w_i ≥ 0 (N·m) at points that were pushed to the side s_i = ±1:
///
///     y = y° + ηWp,     s_i p_i ≥ 0,   s_i y_i ≥ 0,   p_i y_i = w_i;      p_i = 0 where s_i = 0                  (1)
///
/// W (m × m) symmetric positive semidefinite, read by columns on demand. With a = s p, c = s y°, B = η s W s, it is the
/// optimality of
///
///     min ½aᵀB a + cᵀa − Σ w_i ln a_i,     a ≥ 0                                                                (2)
///
/// strictly convex for W regular on the pushed points. There is exactly one solution, whatever y° and w ≥ 0: the
/// weighted centre of a linear complementarity problem. With w_i = 0 it is that problem itself: 0 ≤ a_i ⊥ b_i ≥ 0. One
/// point:
///
///     a = (−c + √(c² + 4Bw)) / 2B                                                                               (3)
///
/// Several points: Gauss–Seidel with (3) once, then Newton on Φ_i(a) = d a_i + b_i − √((d a_i − b_i)² + 4d w_i) with
/// b = c + Ba, d = B_ii (Chen and Harker 1993; Kanzow 1996), zero exactly on (1), halved until |Φ|² falls; where that
/// does not end (w = 0 on points that depend on each other), Gauss–Seidel, each sweep of which lowers (2). A last sweep
/// settles the signs, which are exact. A point with B_ii = 0 cannot be moved: p = w/y° where that is positive.
///
/// Cost: O(k³ + km) for each Newton iteration with k pushed points; only their columns are asked for.
class RestoringSolver {
 public:
  RestoringSolver() = default;
  /// Reserves for m points; solve() allocates nothing after this.
  void prepare(int points);

  struct Lane {
    double reach = 0;                ///< η > 0
    const double* free = nullptr;    ///< y°, m
    const double* pushed = nullptr;  ///< λ, N: s_i is its sign
    const double* way = nullptr;     ///< δ, m: w_i = −λ_i δ_i
    double uncertainty = 0;          ///< of δ, m: λ_i δ_i up to |λ_i| times it is none
    int stride = 1;                  ///< of all four blocks
  };
  /// p of one lane, m numbers. The residual is the largest |Φ_i|, m; convergence means equality to the round-off of
  /// forming y. A λ_i that moved with its point, λ_i δ_i > 0, has no solution: not converged, the residual is δ_i. Not
  /// converged, or data that are not finite: p = 0. The result depends on this lane's numbers only, bit for bit.
  LaneOutcome solve(DelassusColumns& W, const Lane& lane, double* p, int points);

  /// (3), a ≥ 0: the effort that works w ≥ 0 along c + B a; infinite where nothing does.
  static double alone(double c, double B, double w);

  /// Largest numbers of Newton iterations, then of sweeps (default 60 and 4000).
  void limit(int iterations, int sweeps) {
    most_iterations_ = iterations;
    most_sweeps_ = sweeps;
  }

 private:
  bool read(DelassusColumns& W, const Lane& lane, int points, LaneOutcome& outcome);
  bool newton(int& iterations);
  bool find_direction();
  bool sweep();
  void evaluate();
  bool settled() const;
  double norm() const;
  double B(int a, int b) const;

  int count_ = 0;  // k, pushed points
  int most_iterations_ = 60, most_sweeps_ = 4000;
  double reach_ = 0;
  std::vector<int> point_;                            // k
  std::vector<const double*> column_;                 // k
  std::vector<double> side_, free_, work_;            // k: s, c, w
  std::vector<double> effort_, way_, terms_, error_;  // k: a, b, size of its terms, Φ
  std::vector<double> matrix_, direction_, trial_;    // k rows of m, k, k
};

}  // namespace ricochet
