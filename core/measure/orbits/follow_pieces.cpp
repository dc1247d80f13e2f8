#include <algorithm>
#include <cmath>
#include <ricochet/measure/orbits/branch.hpp>
#include <utility>

namespace ricochet {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

BranchState branch_start(VectorXd x, double parameter, SetSequence sets, int way) {
  BranchState state;
  state.along = VectorXd::Zero(x.size());
  state.x = std::move(x);
  state.parameter = parameter;
  state.sets = std::move(sets);
  state.parameter_along = way;
  return state;
}

PieceFollower::PieceFollower(PeriodicMap& map, const MapClock& clock, BranchState entry, double round_off)
    : map_(&map),
      clock_(clock),
      entry_(std::move(entry)),
      derivative_(map.derivative(entry_.sets, clock)),
      round_off_(round_off) {
  enter();
}

void PieceFollower::enter() {
  state_ = entry_;
  new_direction();
  if (state_.change.step < 0 && state_.parameter_along * entry_.parameter_along < 0) {
    state_.along = -state_.along;
    state_.parameter_along = -state_.parameter_along;
  }
  sweep();
}

// The null direction of [P' − 1, P_λ], bordered by the direction before it.
void PieceFollower::new_direction() {
  const Index D = map_->size();
  std::vector<PeriodicMap::Column> column = {{VectorXd::Zero(D), 1.0, true}};
  map_->sweep(state_.sets, clock_, column);
  by_parameter_ = std::move(column.front().x);
  MatrixXd system(D + 1, D + 1);
  system.topLeftCorner(D, D) = MatrixXd::Identity(D, D) - derivative_;
  system.topRightCorner(D, 1) = -by_parameter_;
  system.bottomLeftCorner(1, D) = state_.along.transpose();
  system(D, D) = state_.parameter_along;
  bordered_.compute(system);
  VectorXd right = VectorXd::Zero(D + 1);
  right[D] = 1;
  const VectorXd found = bordered_.solve(right);
  const double size = map_->metric().size(found.head(D), found[D]);
  state_.along = found.head(D) / size;
  state_.parameter_along = found[D] / size;
}

// The orbit and its direction over the steps. Where the next piece ends is as uncertain as the orbit is: one that is
// not solved to round-off is solved again. The new margin of what changed must grow along the branch.
void PieceFollower::sweep() {
  constexpr int most = 3;
  constexpr double singular = 1e10;
  const Index D = map_->size();
  for (int iteration = 0; iteration < most; ++iteration) {
    std::vector<PeriodicMap::Column> columns = {{state_.x, state_.parameter, false},
                                                {state_.along, state_.parameter_along, true}};
    map_->sweep(state_.sets, clock_, columns, &measures_);
    const VectorXd left = columns.front().x - state_.x;
    residual_ = map_->metric().size(left);
    VectorXd right = VectorXd::Zero(D + 1);
    right.head(D) = left;
    const VectorXd correction = bordered_.solve(right);
    if (map_->metric().size(correction.head(D), correction[D]) > singular * residual_) {
      state_.parameter_along = std::numeric_limits<double>::quiet_NaN();  // no direction
      break;
    }
    if (correction.allFinite()) {
      state_.x += correction.head(D);
      state_.parameter += correction[D];
    }
    if (!(residual_ > round_off_)) break;
  }
  const SetChange& change = state_.change;
  if (change.step < 0) return;
  const auto at = static_cast<std::size_t>(change.step * map_->sets().measure_rows() + change.row);
  double grows = measures_.slope[at];
  if (!change.closes) grows -= map_->bound(change.row, change.upper, state_.parameter_along, true);
  if (change.upper) grows = -grows;
  if (grows >= 0) return;
  state_.along = -state_.along;
  state_.parameter_along = -state_.parameter_along;
  for (double& slope : measures_.slope) slope = -slope;
}

Piece PieceFollower::end_of_piece(double least, double largest) {
  Piece piece;
  piece.residual = residual_;
  piece.length = std::numeric_limits<double>::infinity();
  if (!state_.along.allFinite() || !std::isfinite(state_.parameter_along)) {
    piece.end = BranchEnd::unresolved;
    piece.why = "the branch has no direction: two multipliers are 1";
    return piece;
  }
  const int rows = map_->sets().measure_rows();
  const auto n = static_cast<std::size_t>(rows);
  std::vector<double> lower, upper, lower_slope, upper_slope;
  for (int row = 0; row < rows; ++row) {
    lower.push_back(map_->bound(row, false, state_.parameter, false));
    upper.push_back(map_->bound(row, true, state_.parameter, false));
    lower_slope.push_back(map_->bound(row, false, state_.parameter_along, true));
    upper_slope.push_back(map_->bound(row, true, state_.parameter_along, true));
  }
  const SetChange& last = state_.change;
  const double at_once = met_at_once * map_->metric().parameter_metres() * (largest - least);
  const auto meet = [&](double margin, double slope, long long step, int row, bool closes, bool is_upper) {
    // What changed last has a margin of 0 that grows.
    if (!(slope < 0) || (step == last.step && row == last.row && is_upper == last.upper)) return;
    const double s = std::max(0.0, -margin / slope);
    if (s >= piece.length - at_once) {
      piece.tie = piece.tie || s <= piece.length + at_once;
      return;
    }
    piece.tie = false;
    piece.length = s;
    piece.change = {step, row, closes, is_upper};
  };
  for (std::size_t k = 0; k < state_.sets.size(); ++k) {
    const SetStep& step = map_->sets()[state_.sets[k]];
    for (std::size_t r = 0; r < n; ++r) {
      const double v = measures_.value[k * n + r], dv = measures_.slope[k * n + r];
      const auto at = static_cast<long long>(k);
      const int row = static_cast<int>(r), side = step.side[r];
      if (side == 0) {
        if (std::isfinite(lower[r])) meet(v - lower[r], dv - lower_slope[r], at, row, true, false);
        if (std::isfinite(upper[r])) meet(upper[r] - v, upper_slope[r] - dv, at, row, true, true);
      } else {
        meet(side < 0 ? v : -v, side < 0 ? dv : -dv, at, row, false, side > 0);
      }
    }
  }
  const double along = state_.parameter_along, limit = along > 0 ? largest : least;
  // Beyond the limit, by round-off or not, the branch ends at once.
  const double s =
      along == 0 ? std::numeric_limits<double>::infinity() : std::max(0.0, (limit - state_.parameter) / along);
  if (s <= piece.length) {
    piece.tie = false;
    piece.length = s;
    piece.change = {};
    piece.end = BranchEnd::range;
  }
  if (!std::isfinite(piece.length)) {
    piece.end = BranchEnd::unresolved;
    piece.why = "the branch has no end: the parameter does not move along it";
  }
  return piece;
}

BranchState PieceFollower::at(double s) const {
  BranchState there = state_;
  there.x += s * state_.along;
  there.parameter += s * state_.parameter_along;
  there.arc += s;
  return there;
}

void PieceFollower::go(const Piece& piece) {
  entry_ = at(piece.length);
  if (piece.end != BranchEnd::none) {
    state_ = entry_;
    return;
  }
  entry_.change = piece.change;
  ++entry_.pieces;
  const auto step = static_cast<std::size_t>(piece.change.step);
  int& set = entry_.sets[step];
  set = map_->sets().toggled(set, piece.change.row, piece.change.upper);
  derivative_ = entry_.pieces % pieces_updated == 0
                    ? map_->derivative(entry_.sets, clock_)
                    : map_->blended(std::move(derivative_), state_.sets, clock_, {{step, set, 1.0}});
  enter();
}

}  // namespace ricochet
