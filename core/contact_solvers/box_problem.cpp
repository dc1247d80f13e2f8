#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {
namespace {

constexpr std::size_t remembered_sets = 32;

// splitmix64: a set's fingerprint is the sum over its points.
std::uint64_t fingerprint(int point, int side) {
  std::uint64_t z =
      (static_cast<std::uint64_t>(point) * 4 + static_cast<std::uint64_t>(side + 2)) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

void BoxSolver::prepare(int points) {
  assert(points >= 0);
  const auto m = static_cast<std::size_t>(points);
  for (auto* v : {&free_, &lower_, &upper_, &measure_, &effort_, &feasible_, &best_, &diagonal_, &pivot_, &right_,
                  &null_, &compliance_, &step_})
    v->assign(m, 0.0);
  factor_ = std::make_unique_for_overwrite<double[]>(m * m);
  interior_ = {};
  column_.assign(m, nullptr);
  set_.assign(m, 0);
  side_.assign(m, Side::none);
  visited_.clear();
  visited_.reserve(remembered_sets);
}

LaneOutcome BoxSolver::solve(DelassusColumns& W, double reach, Strided<const double> compliance, const double* free,
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
  const double depth = box::beyond_bounds(free, lower, upper);
  if (!std::isfinite(free) || !(lower <= upper)) return {false, 0, infinity};
  if (!(depth > 0)) return {};
  const double a = (A.reach == 0 ? 0.0 : A.reach * A.columns.column(0)[0]) + A.compliance[0];
  if (!(a > 0) || !std::isfinite(a)) return {false, 1, depth};
  p = ((free < lower ? lower : upper) - free) / a;
  const double y = free + a * p;
  const double residual =
      std::max({0.0, box::beyond_bounds(y, lower, upper), box::complementarity(y, lower, upper, p, a)});
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
  const Eigen::Map<const Eigen::ArrayXd> y(f, points), low(l, points), up(u, points);
  depth_ = std::max(0.0, (low - y).max(y - up).maxCoeff());
  size_ = y.abs().maxCoeff();
  // Counts as wide as the numbers, which are then compared in vectors.
  long long improper = 0, violated = 0;
  for (int i = 0; i < points; ++i) {
    assert(!(l[i] > u[i]) && l[i] < infinity && u[i] > -infinity);
    improper += !(f[i] - f[i] == 0) | !(l[i] <= u[i]);
    violated += (f[i] < l[i]) | (f[i] > u[i]);
  }
  violated_ = static_cast<int>(violated);
  first_ = violated > 0 ? points - 1 : 0;
  while (first_ > 0 && !((f[first_] < l[first_]) | (f[first_] > u[first_]))) --first_;
  return improper == 0;
}

// A single violated point by its closed form: most often that is the whole contact.
bool BoxSolver::try_alone(const Operator& A, LaneOutcome& outcome) {
  const int i = first_;
  const double* column = A.columns.column(i);
  const double a = A.reach * column[i] + A.compliance[i];
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

// A = diag(compliance): each point on its own.
LaneOutcome BoxSolver::solve_uncoupled(Strided<const double> compliances) {
  LaneOutcome outcome{true, 1, 0};
  for (int i = 0; i < points_; ++i) {
    const double depth = box::beyond_bounds(free_[i], lower_[i], upper_[i]);
    if (!(depth > 0)) continue;
    const double compliance = compliances[i];
    if (!(compliance > 0)) {
      outcome.converged = false;
      outcome.residual = std::max(outcome.residual, depth);
      continue;
    }
    effort_[i] = ((free_[i] < lower_[i] ? lower_[i] : upper_[i]) - free_[i]) / compliance;
    const double y = free_[i] + compliance * effort_[i];
    outcome.residual = std::max({outcome.residual, box::beyond_bounds(y, lower_[i], upper_[i]),
                                 box::complementarity(y, lower_[i], upper_[i], effort_[i], compliance)});
  }
  return outcome;
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

LaneOutcome BoxSolver::search(const Operator& A, const double* previous, int stride) {
  LaneOutcome outcome;
  outcome.iterations = count_;
  visited_.clear();
  choose_first_set(previous, stride);
  bool looked_inside = false;
  int fewest = points_ + 1;
  for (;;) {
    try_set(A);
    ++outcome.iterations;
    if (all_right()) break;
    // From a set far off, sets of many points go astray for as long as they are followed.
    bool astray = false;
    if (held_ && !looked_inside) {
      const int wrong = wrong_points();
      astray = wrong >= fewest;
      fewest = wrong;
    }
    if (astray || seen_before()) {
      if (looked_inside || !look_inside(A, outcome)) {
        descend(A, outcome);
        break;
      }
      looked_inside = true;
      visited_.clear();
      continue;
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

bool BoxSolver::all_right() const {
  for (int j = 0; j < count_; ++j)
    if (pulls(set_[j])) return false;
  // Active points lie on their bounds, but for round-off that may pass the slack: only then a closer look is needed.
  for (int i = 0; i < points_ && spill_ > 0; ++i)
    if (side_[i] == Side::none && beyond(i) != Side::none) return false;
  return true;
}

int BoxSolver::wrong_points() const {
  int count = 0;
  for (int i = 0; i < points_; ++i) count += side_[i] == Side::none ? beyond(i) != Side::none : active(i) && pulls(i);
  return count;
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

}  // namespace ricochet
