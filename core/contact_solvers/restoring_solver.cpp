#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/contact_solvers/restoring_solver.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Φ without cancellation: 4d(ab − w)/(da + b + √…) where the sum is positive.
double distance(double a, double b, double d, double w) {
  const double sum = d * a + b, root = std::hypot(d * a - b, 2 * std::sqrt(d * w));
  return sum > 0 ? 4 * d * (a * b - w) / (sum + root) : sum - root;
}

}  // namespace

double RestoringSolver::alone(double c, double B, double w) {
  // Free of B where c > 0: there B may be zero.
  const double root = std::hypot(c, 2 * std::sqrt(B * w));
  if (c > 0) return 2 * w / (c + root);
  if (B > 0) return (root - c) / (2 * B);
  return w == 0 && c == 0 ? 0.0 : infinity;
}

void RestoringSolver::prepare(int points) {
  const auto m = static_cast<std::size_t>(points);
  point_.reserve(m);
  column_.reserve(m);
  for (auto* numbers : {&side_, &free_, &work_, &effort_, &way_, &terms_, &error_, &direction_, &trial_})
    numbers->resize(m);
  matrix_.resize(m * m);
}

double RestoringSolver::B(int a, int b) const {
  const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
  return reach_ * side_[i] * side_[j] * column_[j][point_[i]];
}

// Pushed points with their data; false where there is no solution, or none to look for.
bool RestoringSolver::read(DelassusColumns& W, const Lane& lane, int points, LaneOutcome& outcome) {
  point_.clear();
  column_.clear();
  reach_ = lane.reach;
  for (int i = 0; i < points; ++i) {
    const auto at = static_cast<std::size_t>(i) * static_cast<std::size_t>(lane.stride);
    const double pushed = lane.pushed[at], way = lane.way[at], free = lane.free[at];
    if (pushed == 0) continue;
    if (!std::isfinite(pushed) || !std::isfinite(way) || !std::isfinite(free)) {
      outcome = {.converged = false, .residual = infinity};
      return false;
    }
    const double side = pushed > 0 ? 1 : -1, forward = side * way;
    if (forward > lane.uncertainty) {
      outcome.converged = false;
      outcome.residual = std::max(outcome.residual, forward);
    }
    const std::size_t k = point_.size();
    side_[k] = side;
    free_[k] = side * free;
    work_[k] = std::max(0.0, -pushed * way);
    point_.push_back(i);
  }
  count_ = static_cast<int>(point_.size());
  if (!outcome.converged || count_ == 0) return false;
  for (const int i : point_) column_.push_back(W.column(i));
  return true;
}

// b and Φ of the efforts.
void RestoringSolver::evaluate() {
  for (int a = 0; a < count_; ++a) {
    const auto i = static_cast<std::size_t>(a);
    way_[i] = free_[i];
    terms_[i] = std::abs(free_[i]);
  }
  for (int b = 0; b < count_; ++b) {
    const double effort = effort_[static_cast<std::size_t>(b)];
    if (effort == 0) continue;
    for (int a = 0; a < count_; ++a) {
      const double term = B(a, b) * effort;
      way_[static_cast<std::size_t>(a)] += term;
      terms_[static_cast<std::size_t>(a)] += std::abs(term);
    }
  }
  for (int a = 0; a < count_; ++a) {
    const auto i = static_cast<std::size_t>(a);
    error_[i] = distance(effort_[i], way_[i], B(a, a), work_[i]);
  }
}

bool RestoringSolver::settled() const {
  for (int a = 0; a < count_; ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (!(std::abs(error_[i]) <= 4 * (count_ + 1) * epsilon * terms_[i])) return false;
  }
  return true;
}

double RestoringSolver::norm() const {
  double sum = 0;
  for (int a = 0; a < count_; ++a) sum += error_[static_cast<std::size_t>(a)] * error_[static_cast<std::size_t>(a)];
  return sum;
}

// (D_a + D_b B) δa = −Φ with D_a = d(1 − x/r), D_b = 1 + x/r, x = da − b, r = √(x² + 4dw), by elimination.
bool RestoringSolver::find_direction() {
  const auto k = static_cast<std::size_t>(count_);
  const auto at = [&](std::size_t i, std::size_t j) -> double& { return matrix_[i * k + j]; };
  for (std::size_t i = 0; i < k; ++i) {
    const int a = static_cast<int>(i);
    const double d = B(a, a), x = d * effort_[i] - way_[i], r = std::hypot(x, 2 * std::sqrt(d * work_[i]));
    const double slope = r > 0 ? x / r : 0.0;
    for (std::size_t j = 0; j < k; ++j) at(i, j) = (1 + slope) * B(a, static_cast<int>(j));
    at(i, i) += d * (1 - slope);
    direction_[i] = -error_[i];
  }
  for (std::size_t c = 0; c < k; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < k; ++i)
      if (std::abs(at(i, c)) > std::abs(at(pivot, c))) pivot = i;
    if (!(std::abs(at(pivot, c)) > 0)) return false;
    if (pivot != c) {
      for (std::size_t j = c; j < k; ++j) std::swap(at(c, j), at(pivot, j));
      std::swap(direction_[c], direction_[pivot]);
    }
    for (std::size_t i = c + 1; i < k; ++i) {
      const double factor = at(i, c) / at(c, c);
      if (factor == 0) continue;
      for (std::size_t j = c + 1; j < k; ++j) at(i, j) -= factor * at(c, j);
      direction_[i] -= factor * direction_[c];
    }
  }
  for (std::size_t c = k; c-- > 0;) {
    for (std::size_t j = c + 1; j < k; ++j) direction_[c] -= at(c, j) * direction_[j];
    direction_[c] /= at(c, c);
    if (!std::isfinite(direction_[c])) return false;
  }
  return true;
}

bool RestoringSolver::newton(int& iterations) {
  constexpr int most_halvings = 40;
  const auto k = static_cast<std::size_t>(count_);
  for (int iteration = 0; iteration < most_iterations_; ++iteration) {
    evaluate();
    if (settled()) return true;
    ++iterations;
    if (!find_direction()) return false;
    const double before = norm();
    std::copy_n(effort_.begin(), k, trial_.begin());
    double step = 1;
    for (int halvings = 0;; ++halvings, step *= 0.5) {
      for (std::size_t i = 0; i < k; ++i) effort_[i] = trial_[i] + step * direction_[i];
      evaluate();
      if (norm() <= (1 - 1e-4 * step) * before) break;
      if (settled()) return true;
      if (halvings == most_halvings) {
        std::copy_n(trial_.begin(), k, effort_.begin());
        return false;
      }
    }
  }
  return false;
}

// The minimum of (2) along one effort after the other; leaves b and Φ of the end.
bool RestoringSolver::sweep() {
  evaluate();
  for (int a = 0; a < count_; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const double d = B(a, a), found = alone(way_[i] - d * effort_[i], d, work_[i]);
    if (!std::isfinite(found)) return false;
    const double change = found - effort_[i];
    effort_[i] = found;
    if (change == 0) continue;
    for (int b = 0; b < count_; ++b) way_[static_cast<std::size_t>(b)] += B(b, a) * change;
  }
  evaluate();
  return true;
}

LaneOutcome RestoringSolver::solve(DelassusColumns& W, const Lane& lane, double* p, int points) {
  const auto place = [&](int i) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(lane.stride); };
  for (int i = 0; i < points; ++i) p[place(i)] = 0;
  LaneOutcome outcome;
  if (!read(W, lane, points, outcome)) return outcome;
  std::fill_n(effort_.begin(), count_, 0.0);
  bool found = sweep();
  outcome.iterations = 1;
  if (found && count_ > 1) {
    found = newton(outcome.iterations) && sweep();
    // Newton's answer is no worse than round-off; its signs are those of the sweep.
    for (int turn = 0; turn < most_sweeps_ && !settled(); ++turn) {
      ++outcome.iterations;
      if (!sweep()) break;
    }
    found = settled();
  }
  outcome.converged = found;
  for (int a = 0; a < count_; ++a)
    outcome.residual = std::max(outcome.residual, std::abs(error_[static_cast<std::size_t>(a)]));
  if (!std::isfinite(outcome.residual)) outcome = {false, outcome.iterations, infinity};
  if (!outcome.converged) return outcome;
  for (int a = 0; a < count_; ++a)
    p[place(point_[static_cast<std::size_t>(a)])] =
        side_[static_cast<std::size_t>(a)] * effort_[static_cast<std::size_t>(a)];
  return outcome;
}

}  // namespace ricochet
