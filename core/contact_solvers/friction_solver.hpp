#pragma once
#include <array>
#include <ricochet/contract/friction_law.hpp>
#include <vector>

namespace ricochet {

/// The effort of one point with two rows and the bound s: where ½pᵀAp + u°ᵀp is least in the disc |p|₂ ≤ s. In the axes
/// of A, a₁ and a₂ ≥ 0, p_i = −c_i/(a_i + λ). λ = 0 where that lies within, else 1/|p(λ)| = 1/s: concave in λ, so that
/// Newton comes from below without turning back (Moré and Sorensen 1983).
struct DiscEffort {
  std::array<double, 2> effort{};
  bool sticks = false;
};
DiscEffort disc_effort(const std::array<double, 3>& matrix, const std::array<double, 2>& free, double bound,
                       const std::array<double, 2>& guess = {0, 0});

/// Set-valued Coulomb friction with given bounds,
///
///     −u_i ∈ the normal cone of |p_i|₂ ≤ s_i at p_i,     u = u° + A p                                             (1)
///
/// where ½pᵀAp + u°ᵀp is least in the product of the discs. It is convex: p is unique where A is regular, u always.
/// Point by point (Gauss–Seidel, each point exactly), and after each sweep Newton on all points together. A point that
/// stuck before may hold up to its static bound; what does not hold slides at its other one.
class FrictionSolver {
 public:
  /// Reserves; solve() allocates nothing after this.
  void prepare(int points, int rows);
  /// The residual is the largest |p − Π(p − u/tr A_ii)| over the largest s, converged below 1e-12. A case that does
  /// not settle in `most_sweeps` keeps the last p.
  LaneOutcome solve(FrictionProblem& problem);

  static constexpr int most_sweeps = 4000;

 private:
  void measure(const FrictionProblem& problem);
  double sweep(const FrictionProblem& problem);
  double residual(const FrictionProblem& problem) const;
  double move_together(const FrictionProblem& problem, double before);
  double size_of(const FrictionProblem& problem, int point) const;
  bool gives_way(const FrictionProblem& problem, int point) const;
  void put_within(const FrictionProblem& problem, int point);
  bool settle(const FrictionProblem& problem, int& sweeps, double& left);

  struct Way {
    int row, count;  // the first of its rows, and how many
    std::array<double, 2> along;
    double stiff;  // Λ
  };
  std::vector<double> effort_, rate_, bound_, trace_, factor_, right_, kept_;
  std::vector<Way> ways_;
};

}  // namespace ricochet
