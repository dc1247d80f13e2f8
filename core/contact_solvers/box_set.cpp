#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/held_band.hpp>
#include <ricochet/kernels/floating_point.hpp>

/// \file
/// One set of active points: its effort, what that does to all measures, and how far it is from (1).
namespace ricochet {

namespace {

// Dot products of shorter rows are not worth the vector instructions.
constexpr int short_row = 16;

using Array = Eigen::Map<Eigen::ArrayXd>;
using ConstArray = Eigen::Map<const Eigen::ArrayXd>;

}  // namespace

void BoxSolver::try_set(const Operator& A) {
  for (int j = 0; j < count_; ++j) effort_[set_[j]] = 0;
  held_ = band_for(A);
  if (held_) return try_held(A, *held_);
  factorise(A);
  for (int j = 0; j < count_; ++j) right_[j] = bound(set_[j]) - free_[set_[j]];
  substitute();
  for (int j = 0; j < count_; ++j) effort_[set_[j]] = right_[j];
  evaluate(A);
}

// A_SS = L D Lᵀ row by row; points that depend on earlier ones, and immobile ones, leave the set.
// Neighbouring sets of one search begin alike: the rows of what they share stay.
void BoxSolver::factorise(const Operator& A) {
  const int known = known_;
  bool shared = true;
  count_ = 0;
  dropped_ = -1;
  const auto row_length = static_cast<std::size_t>(points_);
  for (int i = 0; i < points_; ++i) {
    if (!active(i)) continue;
    shared = shared && count_ < known && set_[count_] == i;
    if (shared) {
      ++count_;
      continue;
    }
    const double* column = A.columns.column(i);
    const double a = A.reach * column[i] + A.compliance[i];
    if (!(a > 0)) {
      side_[i] = Side::immobile;
      continue;
    }
    double* row = factor_.get() + count_ * row_length;
    double d = a;
    for (int j = 0; j < count_; ++j) {
      const double* earlier = factor_.get() + j * row_length;
      double w = A.reach * column[set_[j]];
      if (j < short_row)
        for (int t = 0; t < j; ++t) w -= earlier[t] * row[t];
      else
        w -= Eigen::Map<const Eigen::VectorXd>(earlier, j).dot(Eigen::Map<const Eigen::VectorXd>(row, j));
      row[j] = w;
    }
    for (int j = 0; j < count_; ++j) {
      const double w = row[j];
      row[j] = w / pivot_[j];
      d -= w * row[j];
    }
    if (!(d > box::round_off(count_) * a)) {
      std::copy_n(row, count_, null_.begin());
      dropped_ = i;
      dropped_side_ = side_[i];
      rank_ = count_;
      side_[i] = Side::none;
      continue;
    }
    set_[count_] = i;
    column_[count_] = column;
    diagonal_[count_] = a;
    pivot_[count_++] = d;
  }
  known_ = count_;
}

void BoxSolver::substitute() {
  const auto row_length = static_cast<std::size_t>(points_);
  for (int j = 0; j < count_; ++j) {
    const double* row = factor_.get() + j * row_length;
    for (int t = 0; t < j; ++t) right_[j] -= row[t] * right_[t];
  }
  for (int j = 0; j < count_; ++j) right_[j] /= pivot_[j];
  for (int j = count_ - 1; j > 0; --j) {
    const double* row = factor_.get() + j * row_length;
    for (int t = 0; t < j; ++t) right_[t] -= row[t] * right_[j];
  }
}

void BoxSolver::evaluate(const Operator& A) {
  Array y(measure_.data(), points_);
  y = ConstArray(free_.data(), points_);
  for (int j = 0; j < count_; ++j) {
    const double effort = effort_[set_[j]];
    y += (A.reach * effort) * ConstArray(column_[j], points_);
    y[set_[j]] += A.compliance[set_[j]] * effort;
  }
  judge();
}

// How far the measures are from their bounds, and what round-off may have to do with it.
void BoxSolver::judge() {
  const ConstArray free(free_.data(), points_), lower(lower_.data(), points_), upper(upper_.data(), points_),
      y(measure_.data(), points_);
  double largest = 0, work = 0;
  for (int j = 0; j < count_; ++j) {
    const double effort = effort_[set_[j]];
    largest = std::max(largest, diagonal_[j]);
    work += diagonal_[j] * effort * effort;
  }
  // Bounds max_i Σ_j |A_ij p_j| by Cauchy–Schwarz on |A_ij| ≤ √(A_ii A_jj).
  terms_ = std::sqrt(count_ * largest * work);
  // A sum that is not finite is the sign of a term that is not.
  worst_ = std::isfinite(y.sum()) ? std::max(0.0, (lower - y).max(y - upper).maxCoeff()) : infinity;
  spill_ = ((lower - y).max(y - upper) - box::round_off(count_) * (free.abs() + y.abs() + terms_)).maxCoeff();
}

// The bound that a free point passes by more than round-off.
BoxSolver::Side BoxSolver::beyond(int i) const {
  const double y = measure_[i];
  const double slack = box::round_off(count_) * (std::abs(free_[i]) + std::abs(y) + terms_);
  return y < lower_[i] - slack ? Side::lower : y > upper_[i] + slack ? Side::upper : Side::none;
}

double BoxSolver::residual() const {
  double worst = worst_;
  for (int j = 0; j < count_; ++j) {
    const int i = set_[j];
    worst = std::max(worst, box::complementarity(measure_[i], lower_[i], upper_[i], effort_[i], diagonal_[j]));
  }
  return worst;
}

double BoxSolver::tolerance() const {
  double size = size_;
  for (int j = 0; j < count_; ++j)
    if (active(set_[j])) size = std::max(size, std::abs(bound(set_[j])));
  return 1e-12 * depth_ + 4 * box::round_off(count_) * (size + terms_);
}

// Sets of many points, held in the band of their operator.

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
    compliance_[i] = active(i) ? A.compliance[i] / A.reach : infinity;
    effort_[i] = 0;
  }
  band.hold(compliance_.data());
  for (int i = 0; i < points_; ++i) {
    right_[i] = 0;
    measure_[i] = free_[i];
    if (!active(i)) continue;
    const double a = A.reach * band.diagonal(i) + A.compliance[i];
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
    for (int i = 0; i < points_; ++i) measure_[i] = free_[i] + A.reach * measure_[i];
    for (int j = 0; j < count_; ++j) measure_[set_[j]] += A.compliance[set_[j]] * effort_[set_[j]];
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
