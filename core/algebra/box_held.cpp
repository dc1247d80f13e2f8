#include <algorithm>
#include <cmath>
#include <ricochet/algebra/box_problem.hpp>
#include <ricochet/algebra/held_band.hpp>
#include <ricochet/algebra/infinity.hpp>

/// \file
/// Sets of many points, held in the band of their operator.
namespace ricochet {
namespace {

HeldBand* band_of(DelassusColumns& columns) {
  auto* band = dynamic_cast<BandDelassus*>(&columns);
  return band ? band->held() : nullptr;
}

}  // namespace

// Few points cost less by their columns.
HeldBand* BoxSolver::band_for(const Operator& A) const {
  if (points_ <= many || std::count_if(side_.begin(), side_.begin() + points_,
                                       [](Side side) { return side == Side::lower || side == Side::upper; }) <= many)
    return nullptr;
  return band_of(A.columns);
}

void BoxSolver::try_held(const Operator& A, HeldBand& band) {
  known_ = count_ = 0;
  dropped_ = -1;
  for (int i = 0; i < points_; ++i) {
    compliance_[i] = active(i) ? A.compliance / A.reach : infinity;
    effort_[i] = 0;
  }
  band.hold(compliance_.data());
  for (int i = 0; i < points_; ++i) {
    right_[i] = 0;
    measure_[i] = free_[i];
    if (!active(i)) continue;
    const double a = A.reach * band.diagonal(i) + A.compliance;
    if (!(a > 0)) {
      side_[i] = Side::immobile;
    } else if (band.dropped(i)) {
      dropped_ = i;
      dropped_side_ = side_[i];
      side_[i] = Side::none;
    } else {
      set_[count_] = i;
      diagonal_[count_++] = a;
    }
  }
  rank_ = count_;

  // The band knows p to its condition times ε; what W itself leaves of the residual corrects it.
  constexpr int most_corrections = 8;
  double before = infinity;
  for (int pass = 0; pass < most_corrections; ++pass) {
    double worst = 0;
    for (int j = 0; j < count_; ++j) {
      const int i = set_[j];
      right_[i] = bound(i) - measure_[i];
      worst = std::max(worst, std::abs(right_[i]));
    }
    if (!(worst < 0.5 * before)) break;
    before = worst;
    band.solve(right_.data(), step_.data());
    for (int j = 0; j < count_; ++j) effort_[set_[j]] += step_[set_[j]] / A.reach;
    band.multiply(effort_.data(), measure_.data());
    for (int i = 0; i < points_; ++i) measure_[i] = free_[i] + A.reach * measure_[i] + A.compliance * effort_[i];
  }
  judge();
}

// What an effort of 1 at the dropped point takes off the others of the set, with its sign: along it no measure moves.
void BoxSolver::find_null() {
  if (held_) {
    held_->solve_column(dropped_, step_.data());
    for (int j = 0; j < rank_; ++j) null_[j] = -step_[set_[j]];
    return;
  }
  for (int j = rank_ - 1; j >= 0; --j) {
    null_[j] = -null_[j];
    const double* row = factor_.get() + j * static_cast<std::size_t>(points_);
    for (int t = 0; t < j; ++t) null_[t] += row[t] * null_[j];
  }
}

// The set of an interior point close to the solution, whatever set was tried before; false: there is no band.
bool BoxSolver::look_inside(const Operator& A, LaneOutcome& outcome) {
  HeldBand* band = points_ > many ? band_of(A.columns) : nullptr;
  if (!band) return false;
  outcome.iterations += interior_.solve(*band, {.reach = A.reach,
                                                .compliance = A.compliance,
                                                .depth = depth_,
                                                .points = points_,
                                                .free = free_.data(),
                                                .lower = lower_.data(),
                                                .upper = upper_.data()});
  for (int i = 0; i < points_; ++i) {
    if (side_[i] == Side::immobile) continue;
    const int side = interior_.side(i);
    side_[i] = side > 0 ? Side::lower : side < 0 ? Side::upper : Side::none;
  }
  return true;
}

}  // namespace ricochet
