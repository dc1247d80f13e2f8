#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <ricochet/algebra/box_problem.hpp>

namespace ricochet {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t remembered_sets = 32;

// Dot products of shorter rows are not worth the vector instructions.
constexpr int short_row = 16;

// splitmix64: a set's fingerprint is the sum over its points.
std::uint64_t fingerprint(int point, int side) {
  std::uint64_t z =
      (static_cast<std::uint64_t>(point) * 4 + static_cast<std::uint64_t>(side + 2)) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

using Array = Eigen::Map<Eigen::ArrayXd>;
using ConstArray = Eigen::Map<const Eigen::ArrayXd>;

// Round-off of a measure with k active points, relative to its terms.
double round_off(int k) {
  return 16 * (k + 1) * epsilon;
}

double beyond_bounds(double y, double lower, double upper) {
  return std::max(lower - y, y - upper);
}

// The terms of (2) that a point with the effort p adds to those without.
double complementarity(double y, double lower, double upper, double p, double diagonal) {
  return p > 0 ? std::min(diagonal * p, y - lower) : std::min(-diagonal * p, upper - y);
}

}  // namespace

void BoxSolver::prepare(int points) {
  assert(points >= 0);
  const auto m = static_cast<std::size_t>(points);
  for (auto* v :
       {&free_, &lower_, &upper_, &measure_, &effort_, &feasible_, &best_, &diagonal_, &pivot_, &right_, &null_})
    v->assign(m, 0.0);
  factor_.assign(m * m, 0.0);
  column_.assign(m, nullptr);
  set_.assign(m, 0);
  side_.assign(m, Side::none);
  visited_.clear();
  visited_.reserve(remembered_sets);
}

LaneOutcome BoxSolver::solve(DelassusColumns& W, double reach, double compliance, const double* free,
                             const double* lower, const double* upper, double* p, int points, int stride) {
  assert(points >= 0 && static_cast<std::size_t>(points) <= free_.size());
  const Operator A{W, reach, compliance};
  known_ = 0;
  if (points == 1) return solve_alone(A, *free, *lower, *upper, *p);
  LaneOutcome outcome;
  if (!read(free, lower, upper, points, stride)) {
    outcome = {false, 0, infinity};
  } else if (violated_ > 0) {
    if (reach == 0)
      outcome = solve_uncoupled(compliance);
    else if (violated_ > 1 || !try_alone(A, outcome))
      outcome = search(A, p, stride);
  }
  for (int i = 0; i < points; ++i) p[i * stride] = effort_[i];
  return outcome;
}

LaneOutcome BoxSolver::solve_alone(const Operator& A, double free, double lower, double upper, double& p) const {
  assert(!(lower > upper));
  p = 0;
  const double depth = beyond_bounds(free, lower, upper);
  if (!std::isfinite(free) || !(lower <= upper)) return {false, 0, infinity};
  if (!(depth > 0)) return {};
  const double a = (A.reach == 0 ? 0.0 : A.reach * A.columns.column(0)[0]) + A.compliance;
  if (!(a > 0) || !std::isfinite(a)) return {false, 1, depth};
  p = ((free < lower ? lower : upper) - free) / a;
  const double y = free + a * p;
  const double residual = std::max({0.0, beyond_bounds(y, lower, upper), complementarity(y, lower, upper, p, a)});
  return {std::isfinite(p), 1, std::isfinite(residual) ? residual : infinity};
}

bool BoxSolver::read(const double* free, const double* lower, const double* upper, int points, int stride) {
  points_ = points;
  count_ = 0;
  best_residual_ = infinity;
  // Locals, because a store through a pointer to double could change any member.
  double *f = free_.data(), *l = lower_.data(), *u = upper_.data();
  for (int i = 0; i < points; ++i) {
    f[i] = free[i * stride];
    l[i] = lower[i * stride];
    u[i] = upper[i * stride];
  }
  std::fill_n(effort_.begin(), points, 0.0);
  const ConstArray y(f, points), low(l, points), up(u, points);
  depth_ = std::max(0.0, (low - y).max(y - up).maxCoeff());
  size_ = y.abs().maxCoeff();
  bool proper = true;
  int violated = 0, first = 0;
  for (int i = 0; i < points; ++i) {
    assert(!(l[i] > u[i]) && l[i] < infinity && u[i] > -infinity);
    proper &= (f[i] - f[i] == 0) & (l[i] <= u[i]);
    const bool beyond = (f[i] < l[i]) | (f[i] > u[i]);
    violated += beyond;
    first = beyond ? i : first;
  }
  violated_ = violated;
  first_ = first;
  return proper;
}

// A single violated point by its closed form: most often that is the whole contact.
bool BoxSolver::try_alone(const Operator& A, LaneOutcome& outcome) {
  const int i = first_;
  const double* column = A.columns.column(i);
  const double a = A.reach * column[i] + A.compliance;
  if (!(a > 0)) return false;
  side_[i] = free_[i] < lower_[i] ? Side::lower : Side::upper;
  count_ = 1;
  set_[0] = i;
  column_[0] = column;
  diagonal_[0] = a;
  effort_[i] = (bound(i) - free_[i]) / a;
  evaluate(A);
  if (spill_ > 0) return false;
  outcome.iterations = 1;
  outcome.residual = residual();
  outcome.converged = outcome.residual <= tolerance();
  return outcome.converged;
}

// The previous contact, or where there was none all violated points.
void BoxSolver::choose_first_set(const double* previous, int stride) {
  bool warm = false;
  for (int i = 0; i < points_; ++i) {
    const double p = previous[i * stride];
    side_[i] = p > 0 && lower_[i] > -infinity ? Side::lower : p < 0 && upper_[i] < infinity ? Side::upper : Side::none;
    warm = warm || side_[i] != Side::none;
  }
  if (warm) return;
  for (int i = 0; i < points_; ++i)
    side_[i] = free_[i] < lower_[i] ? Side::lower : free_[i] > upper_[i] ? Side::upper : Side::none;
}

// A = compliance·I: each point on its own.
LaneOutcome BoxSolver::solve_uncoupled(double compliance) {
  LaneOutcome outcome{true, 1, 0};
  for (int i = 0; i < points_; ++i) {
    const double depth = beyond_bounds(free_[i], lower_[i], upper_[i]);
    if (!(depth > 0)) continue;
    if (!(compliance > 0)) {
      outcome.converged = false;
      outcome.residual = std::max(outcome.residual, depth);
      continue;
    }
    effort_[i] = ((free_[i] < lower_[i] ? lower_[i] : upper_[i]) - free_[i]) / compliance;
    const double y = free_[i] + compliance * effort_[i];
    outcome.residual = std::max({outcome.residual, beyond_bounds(y, lower_[i], upper_[i]),
                                 complementarity(y, lower_[i], upper_[i], effort_[i], compliance)});
  }
  return outcome;
}

LaneOutcome BoxSolver::search(const Operator& A, const double* previous, int stride) {
  LaneOutcome outcome;
  outcome.iterations = count_;
  visited_.clear();
  choose_first_set(previous, stride);
  for (;;) {
    try_set(A);
    ++outcome.iterations;
    if (all_right()) break;
    if (seen_before()) {
      descend(A, outcome);
      break;
    }
    move_all();
  }
  outcome.residual = residual();
  if (best_residual_ < outcome.residual) {
    outcome.residual = best_residual_;
    std::copy_n(best_.begin(), points_, effort_.begin());
  }
  outcome.converged = outcome.residual <= tolerance();
  if (!std::isfinite(outcome.residual)) std::fill_n(effort_.begin(), points_, 0.0);
  return outcome;
}

void BoxSolver::try_set(const Operator& A) {
  for (int j = 0; j < count_; ++j) effort_[set_[j]] = 0;
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
    const double a = A.reach * column[i] + A.compliance;
    if (!(a > 0)) {
      side_[i] = Side::immobile;
      continue;
    }
    double* row = factor_.data() + count_ * row_length;
    double d = a;
    for (int j = 0; j < count_; ++j) {
      const double* earlier = factor_.data() + j * row_length;
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
    if (!(d > round_off(count_) * a)) {
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
    const double* row = factor_.data() + j * row_length;
    for (int t = 0; t < j; ++t) right_[j] -= row[t] * right_[t];
  }
  for (int j = 0; j < count_; ++j) right_[j] /= pivot_[j];
  for (int j = count_ - 1; j > 0; --j) {
    const double* row = factor_.data() + j * row_length;
    for (int t = 0; t < j; ++t) right_[t] -= row[t] * right_[j];
  }
}

void BoxSolver::evaluate(const Operator& A) {
  const ConstArray free(free_.data(), points_), lower(lower_.data(), points_), upper(upper_.data(), points_);
  Array y(measure_.data(), points_);
  y = free;
  double largest = 0, work = 0;
  for (int j = 0; j < count_; ++j) {
    const double effort = effort_[set_[j]];
    y += (A.reach * effort) * ConstArray(column_[j], points_);
    y[set_[j]] += A.compliance * effort;
    largest = std::max(largest, diagonal_[j]);
    work += diagonal_[j] * effort * effort;
  }
  // Bounds max_i Σ_j |A_ij p_j| by Cauchy–Schwarz on |A_ij| ≤ √(A_ii A_jj).
  terms_ = std::sqrt(count_ * largest * work);
  // A sum that is not finite is the sign of a term that is not.
  worst_ = std::isfinite(y.sum()) ? std::max(0.0, (lower - y).max(y - upper).maxCoeff()) : infinity;
  spill_ = ((lower - y).max(y - upper) - round_off(count_) * (free.abs() + y.abs() + terms_)).maxCoeff();
}

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
  for (int j = rank_ - 1; j >= 0; --j) {
    null_[j] = -null_[j];
    const double* row = factor_.data() + j * static_cast<std::size_t>(points_);
    for (int t = 0; t < j; ++t) null_[t] += row[t] * null_[j];
  }
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
    const double d = beyond_bounds(measure_[i], lower_[i], upper_[i]);
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

double BoxSolver::bound(int i) const {
  return side_[i] == Side::lower ? lower_[i] : upper_[i];
}

bool BoxSolver::active(int i) const {
  return side_[i] == Side::lower || side_[i] == Side::upper;
}

bool BoxSolver::pulls(int i) const {
  return side_[i] == Side::lower ? effort_[i] < 0 : effort_[i] > 0;
}

// The bound that a free point passes by more than round-off.
BoxSolver::Side BoxSolver::beyond(int i) const {
  const double y = measure_[i];
  const double slack = round_off(count_) * (std::abs(free_[i]) + std::abs(y) + terms_);
  return y < lower_[i] - slack ? Side::lower : y > upper_[i] + slack ? Side::upper : Side::none;
}

bool BoxSolver::all_right() const {
  for (int j = 0; j < count_; ++j)
    if (pulls(set_[j])) return false;
  // Active points lie on their bounds, but for round-off that may pass the slack: only then a closer look is needed.
  for (int i = 0; i < points_ && spill_ > 0; ++i)
    if (side_[i] == Side::none && beyond(i) != Side::none) return false;
  return true;
}

void BoxSolver::move_all() {
  for (int i = 0; i < points_; ++i)
    if (side_[i] == Side::none) side_[i] = beyond(i);
  for (int j = 0; j < count_; ++j) {
    const int i = set_[j];
    if (!pulls(i)) continue;
    const double without = bound(i) - diagonal_[j] * effort_[i];
    side_[i] = without < lower_[i] ? Side::lower : without > upper_[i] ? Side::upper : Side::none;
  }
}

// Remembers the set; a full memory counts as a repetition, which is safe: descent starts from any set.
bool BoxSolver::seen_before() {
  std::uint64_t sum = 0;
  for (int i = 0; i < points_; ++i)
    if (active(i)) sum += fingerprint(i, static_cast<int>(side_[i]));
  if (std::find(visited_.begin(), visited_.end(), sum) != visited_.end() || visited_.size() == remembered_sets)
    return true;
  visited_.push_back(sum);
  return false;
}

double BoxSolver::residual() const {
  double worst = worst_;
  for (int j = 0; j < count_; ++j) {
    const int i = set_[j];
    worst = std::max(worst, complementarity(measure_[i], lower_[i], upper_[i], effort_[i], diagonal_[j]));
  }
  return worst;
}

double BoxSolver::tolerance() const {
  double size = size_;
  for (int j = 0; j < count_; ++j)
    if (active(set_[j])) size = std::max(size, std::abs(bound(set_[j])));
  return 1e-12 * depth_ + 4 * round_off(count_) * (size + terms_);
}

}  // namespace ricochet
