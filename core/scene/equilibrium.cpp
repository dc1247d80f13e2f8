#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ricochet/contact_solvers/circle_solver.hpp>
#include <ricochet/contract/errors.hpp>
#include <ricochet/kernels/sparse_ldlt.hpp>
#include <ricochet/scene/semi_discrete.hpp>
#include <ricochet/scene/stop_parameters.hpp>

namespace ricochet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* said_at = "/scene/initial/equilibrium";

class KnownColumns final : public DelassusColumns {
 public:
  explicit KnownColumns(MatrixXd columns) : columns_(std::move(columns)) {}
  const double* column(int j) override { return columns_.col(j).data(); }

 private:
  MatrixXd columns_;
};

class Balance {
 public:
  Balance(const SemiDiscrete& problem, const VectorXd& lift, ContactLaw* law, double shift)
      : problem_(problem), lift_(lift), law_(law), is_held_(shift == 0), columns_(MatrixXd()) {
    diagonal_ = problem.stiffness.diagonal();
    const double largest = diagonal_.maxCoeff() > 0 ? diagonal_.maxCoeff() : 1.0;
    for (double& one : diagonal_) one = shift * (one > 0 ? one : largest);
    SparseMatrix D(problem.stiffness.rows(), problem.stiffness.cols());
    for (Index i = 0; i < D.rows(); ++i) D.insert(i, i) = diagonal_[i];
    if (!ldlt_.factorise(problem.stiffness + D))
      throw InputError(said_at, "the stiffness of the structure has no factor: " + ldlt_.reason());
    const Index points = problem.points();
    moved_.resize(problem.stiffness.rows(), points);
    for (Index i = 0; i < points; ++i) moved_.col(i) = solved(problem.measured().row(i).transpose());
    columns_ = KnownColumns(problem.measured() * moved_);
    const bool own = law && sets_per_point(*law, problem.own);
    lower_ = problem.lower;
    upper_ = problem.upper;
    for (int i = 0; law && i < problem.points(); ++i) {
      lower_[i] += law->layer(own ? i : 0);
      upper_[i] -= law->layer(own ? i : 0);
    }
    effort_ = VectorXd::Zero(points);
    if (law) circles_.prepare(problem.points(), 1, problem.circles(), law->memory_per_point());
  }

  /// q and p of K + D under F + D q⁻.
  VectorXd step(const VectorXd& load, const VectorXd& before) {
    const VectorXd open = solved(load + diagonal_.cwiseProduct(before));
    if (law_ && problem_.points() > 0) push(problem_.measured() * open + lift_);
    return open + moved_ * effort_;
  }
  const VectorXd& effort() const { return effort_; }

  /// Moves points that push against rigid bounds from where a solve left them, K⁻¹ times round-off, onto these bounds.
  /// There each lies beyond by what its place is rounded to in any coordinates, so that every scheme finds it closed.
  void put_on_bounds(VectorXd& q) {
    if (!law_ || law_->reads()) return;
    const std::vector<Pressed> pressed = pressed_points(q);
    const auto count = static_cast<Index>(pressed.size());
    if (count == 0) return;
    MatrixXd directions(count, problem_.points());
    for (Index k = 0; k < count; ++k) directions.row(k) = pressed[static_cast<std::size_t>(k)].direction;
    const MatrixXd compliance = directions * problem_.measured() * moved_ * directions.transpose();
    const auto factor = compliance.completeOrthogonalDecomposition();
    constexpr int turns = 2;  // the first leaves round-off of its own
    for (int turn = 0; turn < turns; ++turn) {
      const VectorXd place = directions * (problem_.measured() * q + lift_);
      VectorXd left(count);
      for (Index k = 0; k < count; ++k) left[k] = pressed[static_cast<std::size_t>(k)].bound - place[k];
      const VectorXd more = directions.transpose() * factor.solve(left);
      effort_ += more;
      q += moved_ * more;
    }
  }

 private:
  /// d·x = b: a point, or a circle, that pushes.
  struct Pressed {
    Eigen::RowVectorXd direction;  // d, of the places of all points
    double bound = 0;              // b, m
  };

  std::vector<Pressed> pressed_points(const VectorXd& q) const {
    // Of what the efforts move a point by: sums in modes are rounded to less. What nothing holds is moved by no effort.
    constexpr double rounded = 1e-13;
    const VectorXd place = problem_.measured() * q + lift_;
    const VectorXd moved = is_held_ ? VectorXd(problem_.measured() * (moved_ * effort_)) : place;
    std::vector<Pressed> found;
    for (int i = 0; i < problem_.points(); ++i) {
      const int axis = problem_.circle_axis(i);
      const double size = axis == 0 ? std::hypot(effort_[i], effort_[i + 1]) : std::abs(effort_[i]);
      if (axis == 1 || size == 0) continue;
      Pressed one{Eigen::RowVectorXd::Zero(problem_.points())};
      if (axis == 0) {
        const StopCircle circle = StopCircle::of(lower_, upper_, i);
        one.direction[i] = -effort_[i] / size;
        one.direction[i + 1] = -effort_[i + 1] / size;
        one.bound = circle.radius + one.direction[i] * circle.centre[0] + one.direction[i + 1] * circle.centre[1];
      } else {
        one.direction[i] = effort_[i] > 0 ? -1 : 1;
        one.bound = effort_[i] > 0 ? -lower_[i] : upper_[i];
      }
      one.bound += rounded * std::abs(one.direction.dot(moved));
      found.push_back(std::move(one));
    }
    return found;
  }

  VectorXd solved(const VectorXd& right) {
    VectorXd x(right.size());
    ldlt_.solve(right.data(), x.data());
    return x;
  }

  // A mean over a step knows the depth before it, which at rest is the depth.
  void push(const VectorXd& free) {
    constexpr int most = 200;
    constexpr double settled = 1e-14;
    const auto points = static_cast<std::size_t>(problem_.points());
    std::vector<double> still(points, 0.0), memory(points * static_cast<std::size_t>(law_->memory_per_point()), 0.0);
    VectorXd place = free + problem_.measured() * (moved_ * effort_);
    const bool mean = law_->reads() == Evaluation::conserving;
    const std::array<int, 1> touched{0};
    LaneOutcome outcome;
    for (int k = 0; k < (mean ? most : 1); ++k) {
      ReducedProblem reduced;
      reduced.points = problem_.points();
      reduced.lanes = 1;
      reduced.delassus = &columns_;
      reduced.reach = 1;
      reduced.free = free.data();
      reduced.lower = lower_.data();
      reduced.upper = upper_.data();
      reduced.rate_free = still.data();
      reduced.before = mean ? place.data() : nullptr;
      reduced.memory = memory.empty() ? nullptr : memory.data();
      reduced.effort = effort_.data();
      reduced.touched = touched;
      reduced.outcome = &outcome;
      circles_.solve(*law_, reduced);
      const VectorXd next = free + problem_.measured() * (moved_ * effort_);
      const double change = (next - place).norm();
      place = next;
      if (change <= settled * place.norm()) break;
    }
    if (!outcome.converged || !effort_.allFinite())
      throw InputError(said_at, "the contact law finds no force that holds the structure at rest");
  }

  const SemiDiscrete& problem_;
  VectorXd lift_;
  ContactLaw* law_;
  bool is_held_;
  SparseLdlt ldlt_;
  MatrixXd moved_;  // (K + D)⁻¹Gᵀ
  KnownColumns columns_;
  CircleSolver circles_;
  VectorXd diagonal_, lower_, upper_, effort_;
};

bool has_factor(const SparseMatrix& stiffness) {
  SparseLdlt ldlt;
  return ldlt.factorise(stiffness);
}

/// `on_bounds`: with what pushes put on its bounds.
Equilibrium balanced_state(const SemiDiscrete& problem, const VectorXd& load, const VectorXd& lift, ContactLaw* law,
                           bool on_bounds) {
  ContactLaw* acting = law && !law->absent() ? law : nullptr;
  const bool held = (problem.held || problem.in_modes()) && has_factor(problem.stiffness);
  VectorXd q = VectorXd::Zero(problem.stiffness.rows());
  const double size = load.norm();
  constexpr double balanced = 1e-12, units = 8 * std::numeric_limits<double>::epsilon();
  // The slowest motion takes diag(D)/k times as many steps, k its stiffness: of many elements with a smaller D. That
  // one goes down to what K q is rounded to.
  bool first = true;
  for (const double shift : held ? std::vector{0.0} : std::vector{1e-3, 1e-6, 1e-9}) {
    constexpr int most_steps = 2000;
    Balance balance(problem, lift, acting, shift);
    for (int k = 0; k < (held ? 1 : most_steps); ++k) {
      q = balance.step(load, q);
      const VectorXd pushed = problem.measured().transpose() * balance.effort();
      const double left = (problem.stiffness * q - load - pushed).norm(),
                   rounded = first ? 0 : units * (problem.stiffness.cwiseAbs() * q.cwiseAbs()).norm();
      if (held || left <= std::max(balanced * std::max(size, (problem.stiffness * q).norm()), rounded)) {
        if (on_bounds) balance.put_on_bounds(q);
        return {q, problem.measured().transpose() * balance.effort()};
      }
    }
    first = false;
  }
  throw InputError(said_at,
                   "no stop balances what pushes a structure that nothing holds; expected supports, or stops against "
                   "the load");
}

}  // namespace

Equilibrium equilibrium(const SemiDiscrete& problem, const VectorXd& load, const VectorXd& lift, ContactLaw* law) {
  return balanced_state(problem, load, lift, law, true);
}

std::optional<double> lowest_potential(const SemiDiscrete& problem, const VectorXd& load, ContactLaw* law) {
  const VectorXd lift = lift_at_start(problem);
  VectorXd q;
  try {
    q = balanced_state(problem, load, lift, law, false).position;
  } catch (const InputError&) {
    return std::nullopt;
  }
  double energy = 0.5 * q.dot(problem.stiffness * q) - load.dot(q);
  if (!law || law->absent() || !law->reads()) return energy;
  const VectorXd place = problem.measured() * q + lift;
  const bool own = sets_per_point(*law, problem.own);
  CircleSolver circles;
  circles.prepare(problem.points(), 1, problem.circles(), 0);
  each_side(circles, problem.lower, problem.upper, place.data(), [&](int i, int side, double depth) {
    const StopState state{.depth = depth, .set = own ? i : 0, .side = side};
    if (depth > -law->layer(state.set)) energy += law->potential(state);
  });
  return energy;
}

}  // namespace ricochet
