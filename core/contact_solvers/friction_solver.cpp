#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ricochet/contact_solvers/friction_solver.hpp>

namespace ricochet {
namespace {

constexpr double exact = 1e-15, accepted = 1e-12;
// A pivot this small against its diagonal belongs to a row that depends on those before it.
constexpr double dependent = 1e-13;
constexpr int most_disc_steps = 60, most_cuts = 12;

std::size_t place(int i) {
  return static_cast<std::size_t>(i);
}

// Of one or two numbers.
double norm(const double* x, int count) {
  return count == 1 ? std::abs(x[0]) : std::hypot(x[0], x[1]);
}

}  // namespace

DiscEffort disc_effort(const std::array<double, 3>& matrix, const std::array<double, 2>& free, double bound,
                       const std::array<double, 2>& guess) {
  if (!(bound > 0)) return {};
  const auto [a, b, d] = matrix;
  const double half = 0.5 * (a - d), radius = std::hypot(half, b), middle = 0.5 * (a + d);
  // The axis of the larger of both, as the better conditioned of two forms.
  double x = half >= 0 ? half + radius : b, y = half >= 0 ? b : radius - half;
  const double length = std::hypot(x, y);
  if (length > 0) {
    x /= length;
    y /= length;
  } else {
    x = 1;
  }
  const std::array<double, 2> values{middle + radius, std::max(middle - radius, 0.0)};
  const std::array<double, 2> along{x * free[0] + y * free[1], x * free[1] - y * free[0]};
  const auto turned = [&](double first, double second) {
    return std::array<double, 2>{x * first - y * second, y * first + x * second};
  };
  // Below this λ one of both parts alone is beyond the bound.
  double lambda = 0;
  for (const std::size_t i : {0, 1}) lambda = std::max(lambda, std::abs(along[i]) / bound - values[i]);
  const auto part = [&](std::size_t i) {
    const double below = values[i] + lambda;
    // Nothing answers, nothing pushes: what it had.
    if (below == 0) return i == 0 ? x * guess[0] + y * guess[1] : x * guess[1] - y * guess[0];
    return -along[i] / below;
  };
  std::array<double, 2> p{part(0), part(1)};
  if (lambda == 0 && std::hypot(p[0], p[1]) <= bound) return {turned(p[0], p[1]), true};
  for (int step = 0; step < most_disc_steps; ++step) {
    const double size = std::hypot(p[0], p[1]);
    double slope = 0;
    for (const std::size_t i : {0, 1})
      if (values[i] + lambda > 0) slope += p[i] * p[i] / (values[i] + lambda);
    const double change = slope > 0 ? (size - bound) / bound * (size * size / slope) : 0.0;
    if (!(change > exact * lambda)) break;
    lambda += change;
    p = {part(0), part(1)};
  }
  // To the circle itself: the last step leaves round-off.
  const double size = std::hypot(p[0], p[1]), scale = size > 0 ? bound / size : 0.0;
  return {turned(scale * p[0], scale * p[1]), false};
}

inline double FrictionSolver::size_of(const FrictionProblem& problem, int point) const {
  const int first = problem.first_row[point];
  return norm(effort_.data() + first, problem.first_row[point + 1] - first);
}

inline void FrictionSolver::put_within(const FrictionProblem& problem, int point) {
  const double size = size_of(problem, point), s = bound_[place(point)];
  if (size <= s) return;
  for (int i = problem.first_row[point]; i < problem.first_row[point + 1]; ++i) effort_[place(i)] *= s / size;
}

void FrictionSolver::prepare(int points, int rows) {
  effort_.resize(place(rows));
  rate_.resize(place(rows));
  right_.resize(place(rows));
  factor_.resize(place(rows) * place(rows));
  bound_.resize(place(points));
  trace_.resize(place(points));
  kept_.resize(place(rows));
  ways_.reserve(place(rows));
}

// u = u° + A p.
void FrictionSolver::measure(const FrictionProblem& problem) {
  const int rows = problem.rows();
  std::copy_n(problem.free, rows, rate_.begin());
  for (int j = 0; j < rows; ++j)
    if (const double p = effort_[place(j)]; p != 0)
      for (int i = 0; i < rows; ++i) rate_[place(i)] += problem.at(i, j) * p;
}

// Each point against the others as they are; by how much the largest effort changed.
double FrictionSolver::sweep(const FrictionProblem& problem) {
  double most = 0;
  const int rows = problem.rows();
  for (int point = 0; point < problem.points; ++point) {
    const int first = problem.first_row[point], count = problem.first_row[point + 1] - first;
    const double s = bound_[place(point)], *p = effort_.data() + first;
    double next[2] = {0, 0};
    if (count == 1) {
      const double own = problem.at(first, first), u = rate_[place(first)] - own * p[0];
      next[0] = own > 0 ? std::clamp(-u / own, -s, s) : u == 0 ? std::clamp(p[0], -s, s) : std::copysign(s, -u);
    } else {
      std::array<double, 2> u{};
      for (const int k : {0, 1}) {
        u[place(k)] = rate_[place(first + k)];
        for (const int l : {0, 1}) u[place(k)] -= problem.at(first + k, first + l) * p[l];
      }
      const auto found =
          disc_effort({problem.at(first, first), problem.at(first, first + 1), problem.at(first + 1, first + 1)}, u, s,
                      {p[0], p[1]});
      next[0] = found.effort[0];
      next[1] = found.effort[1];
    }
    for (int k = 0; k < count; ++k) {
      const double change = next[k] - p[k];
      if (change == 0) continue;
      most = std::max(most, std::abs(change));
      effort_[place(first + k)] = next[k];
      for (int i = 0; i < rows; ++i) rate_[place(i)] += problem.at(i, first + k) * change;
    }
  }
  return most;
}

// By the natural map, N.
double FrictionSolver::residual(const FrictionProblem& problem) const {
  double most = 0;
  for (int point = 0; point < problem.points; ++point) {
    const int first = problem.first_row[point], count = problem.first_row[point + 1] - first;
    const double s = bound_[place(point)], trace = trace_[place(point)];
    double moved[2] = {0, 0};
    for (int k = 0; k < count; ++k)
      moved[k] = effort_[place(first + k)] - (trace > 0 ? rate_[place(first + k)] / trace : 0.0);
    const double size = norm(moved, count), scale = size > s ? s / size : 1.0;
    for (int k = 0; k < count; ++k) most = std::max(most, std::abs(effort_[place(first + k)] - scale * moved[k]));
  }
  return most;
}

// Newton on (1) with the set as it is: points within their bounds move by all their rows to u = 0. Points on a disc
// move along its edge by τ, to where u has no part along it,
//
//     Zᵀ(A + Λ)Z (δp, τ) = −Zᵀu,     Λ = |u|/s of points on the edge
//
// Cut to the bounds, and halved until the residual does not grow; what is left of it.
double FrictionSolver::move_together(const FrictionProblem& problem, double before) {
  ways_.clear();
  for (int point = 0; point < problem.points; ++point) {
    const int first = problem.first_row[point], count = problem.first_row[point + 1] - first;
    const double size = size_of(problem, point), s = bound_[place(point)];
    if (size < s * (1 - accepted)) {
      for (int k = 0; k < count; ++k) ways_.push_back({first + k, 1, {1, 0}, 0});
    } else if (count == 2 && s > 0) {
      const double x = effort_[place(first)] / size, y = effort_[place(first + 1)] / size;
      ways_.push_back({first, 2, {-y, x}, std::hypot(rate_[place(first)], rate_[place(first + 1)]) / s});
    }
  }
  const auto size = static_cast<int>(ways_.size());
  const auto L = [&](int i, int j) -> double& { return factor_[place(i) * rate_.size() + place(j)]; };
  const auto entry = [&](const Way& a, const Way& b) {
    double sum = 0;
    for (int k = 0; k < a.count; ++k)
      for (int l = 0; l < b.count; ++l) sum += a.along[place(k)] * problem.at(a.row + k, b.row + l) * b.along[place(l)];
    return sum;
  };
  for (int i = 0; i < size; ++i) {
    const Way& own = ways_[place(i)];
    double diagonal = entry(own, own) + own.stiff;
    const double whole = diagonal;
    for (int j = 0; j < i; ++j) {
      double sum = entry(own, ways_[place(j)]);
      for (int l = 0; l < j; ++l) sum -= L(i, l) * L(j, l) * L(l, l);
      L(i, j) = L(j, j) != 0 ? sum / L(j, j) : 0.0;
      diagonal -= L(i, j) * L(i, j) * L(j, j);
    }
    L(i, i) = diagonal > dependent * whole ? diagonal : 0.0;
    double right = 0;
    for (int k = 0; k < own.count; ++k) right -= own.along[place(k)] * rate_[place(own.row + k)];
    for (int l = 0; l < i; ++l) right -= L(i, l) * right_[place(l)];
    right_[place(i)] = right;
  }
  for (int i = size; i-- > 0;) {
    right_[place(i)] = L(i, i) != 0 ? right_[place(i)] / L(i, i) : 0.0;
    for (int l = i + 1; l < size; ++l) right_[place(i)] -= L(l, i) * right_[place(l)];
  }
  std::copy(effort_.begin(), effort_.end(), kept_.begin());
  double share = 1;
  for (int halving = 0; halving < most_cuts; ++halving, share *= 0.5) {
    for (int i = 0; i < size; ++i) {
      const Way& way = ways_[place(i)];
      for (int k = 0; k < way.count; ++k) effort_[place(way.row + k)] += share * way.along[place(k)] * right_[place(i)];
    }
    for (int point = 0; point < problem.points; ++point) put_within(problem, point);
    measure(problem);
    if (const double after = residual(problem); after <= before) return after;
    std::copy(kept_.begin(), kept_.end(), effort_.begin());
  }
  measure(problem);
  return residual(problem);
}

bool FrictionSolver::settle(const FrictionProblem& problem, int& sweeps, double& left) {
  double largest = 0;
  for (int point = 0; point < problem.points; ++point) largest = std::max(largest, bound_[place(point)]);
  for (; sweeps < most_sweeps; ++sweeps) {
    const double change = sweep(problem);
    left = residual(problem);
    if (problem.points == 1 || change <= exact * largest || left <= exact * largest) return true;
    left = move_together(problem, left);
    if (left <= exact * largest) return true;
  }
  return left <= accepted * largest;
}

// At its bound, and on its way: beside others one may bear all it can, and rest.
bool FrictionSolver::gives_way(const FrictionProblem& problem, int point) const {
  const double s = bound_[place(point)];
  if (size_of(problem, point) < s * (1 - accepted)) return false;
  const int first = problem.first_row[point], end = problem.first_row[point + 1];
  return problem.points == 1 || norm(rate_.data() + first, end - first) > accepted * s * trace_[place(point)];
}

LaneOutcome FrictionSolver::solve(FrictionProblem& problem) {
  LaneOutcome outcome;
  double largest = 0, left = 0;
  for (int point = 0; point < problem.points; ++point) {
    double& s = bound_[place(point)];
    s = problem.bound_static ? std::max(problem.bound[point], problem.bound_static[point]) : problem.bound[point];
    largest = std::max(largest, s);
    trace_[place(point)] = 0;
    for (int i = problem.first_row[point]; i < problem.first_row[point + 1]; ++i) {
      trace_[place(point)] += problem.at(i, i);
      effort_[place(i)] = problem.effort[i];
    }
    put_within(problem, point);
  }
  measure(problem);
  // What gives way at the static bound slides at the other one; no point goes back, so that this ends.
  for (bool again = true; again;) {
    outcome.converged = settle(problem, outcome.iterations, left);
    again = false;
    for (int point = 0; point < problem.points; ++point) {
      double& s = bound_[place(point)];
      if (!(s > problem.bound[point]) || !gives_way(problem, point)) continue;
      s = problem.bound[point];
      put_within(problem, point);
      again = true;
    }
    if (again) measure(problem);
  }
  outcome.residual = largest > 0 ? left / largest : 0.0;
  for (int point = 0; point < problem.points; ++point) {
    const bool sticks = !gives_way(problem, point);
    const int first = problem.first_row[point], end = problem.first_row[point + 1];
    for (int i = first; i < end; ++i) problem.effort[i] = effort_[place(i)];
    problem.sticks[point] = sticks;
    problem.slid[point] = sticks ? 0.0 : norm(rate_.data() + first, end - first);
  }
  return outcome;
}

}  // namespace ricochet
