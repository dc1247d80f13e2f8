#include <algorithm>
#include <ricochet/algebra/box_problem.hpp>
#include <ricochet/algebra/box_round_off.hpp>
#include <ricochet/algebra/infinity.hpp>

/// \file
/// Monotone descent: sets that only ever decrease the sum of (1), from any set.
namespace ricochet {

void BoxSolver::descend(const Operator& A, LaneOutcome& outcome) {
  for (int i = 0; i < points_; ++i) {
    if (active(i) && (effort_[i] == 0 || pulls(i))) side_[i] = Side::none;
    feasible_[i] = active(i) ? effort_[i] : 0.0;
  }
  const int limit = set_limit_ < 0 ? 50 * points_ + 200 : set_limit_;
  int entering = -1;
  for (int tried = 0; tried < limit; ++tried) {
    try_set(A);
    ++outcome.iterations;
    if (dropped_ >= 0) {
      if (!slide(entering)) return;
      continue;
    }
    double step = 1;
    const int leaving = first_to_leave(step);
    if (leaving < 0) {
      for (int j = 0; j < count_; ++j) feasible_[set_[j]] = effort_[set_[j]];
      keep_best();
      entering = deepest();
      if (entering < 0 || best_residual_ <= tolerance()) return;
      side_[entering] = beyond(entering);
      continue;
    }
    // The entering point would leave at once: its violation was round-off.
    if (leaving == entering && feasible_[entering] == 0) return;
    for (int j = 0; j < count_; ++j) {
      const int i = set_[j];
      feasible_[i] += step * (effort_[i] - feasible_[i]);
    }
    feasible_[leaving] = 0;
    side_[leaving] = Side::none;
  }
}

// A_SS is singular: along its null vector y does not move, and the sum decreases at the rate at which the entering
// point's violation is worked on, until a point of the set has no effort left. If none ever has, no p satisfies (1).
bool BoxSolver::slide(int entering) {
  find_null();
  side_[dropped_] = dropped_side_;
  double along = dropped_ == entering ? 1 : 0;
  for (int j = 0; j < rank_; ++j)
    if (set_[j] == entering) along = null_[j];
  const double sign = entering >= 0 && (along < 0) == (side_[entering] == Side::lower) ? -1 : 1;

  int leaving = -1;
  double step = infinity;
  const auto look = [&](int i, double rate) {
    if (i == entering || (side_[i] == Side::lower ? rate >= 0 : rate <= 0)) return;
    const double until = -feasible_[i] / rate;
    if (until < step) {
      step = until;
      leaving = i;
    }
  };
  for (int j = 0; j < rank_; ++j) look(set_[j], sign * null_[j]);
  look(dropped_, sign);
  if (leaving < 0) return false;
  for (int j = 0; j < rank_; ++j) feasible_[set_[j]] += step * sign * null_[j];
  feasible_[dropped_] += step * sign;
  feasible_[leaving] = 0;
  side_[leaving] = Side::none;
  return true;
}

// The first point whose effort changes sign on the way from feasible_ to effort_, and the part of the way until there.
int BoxSolver::first_to_leave(double& step) const {
  int leaving = -1;
  for (int j = 0; j < count_; ++j) {
    const int i = set_[j];
    if (!pulls(i)) continue;
    const double until = feasible_[i] / (feasible_[i] - effort_[i]);
    if (leaving < 0 || until < step) {
      step = until;
      leaving = i;
    }
  }
  return leaving;
}

int BoxSolver::deepest() const {
  int found = -1;
  double depth = 0;
  for (int i = 0; i < points_; ++i) {
    const double d = box::beyond_bounds(measure_[i], lower_[i], upper_[i]);
    if (d > depth && side_[i] == Side::none && beyond(i) != Side::none) {
      depth = d;
      found = i;
    }
  }
  return found;
}

void BoxSolver::keep_best() {
  const double r = residual();
  if (!(r < best_residual_)) return;
  best_residual_ = r;
  std::copy_n(effort_.begin(), points_, best_.begin());
}

}  // namespace ricochet
