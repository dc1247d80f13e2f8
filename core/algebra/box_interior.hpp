#pragma once
#include <vector>

namespace ricochet {

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
    double reach = 0, compliance = 0;  ///< A = reach·W + compliance·I
    double depth = 0;                  ///< deepest violation of y°, > 0
    int points = 0;
    const double *free = nullptr, *lower = nullptr, *upper = nullptr;
  };

  /// Ends when the mean of a s and b t is 1e-12 of what it was, or no step is left; says after how many iterations.
  /// Allocates when there are more points than ever before.
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

}  // namespace ricochet
