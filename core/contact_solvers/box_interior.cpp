#include <algorithm>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <ricochet/contact_solvers/held_band.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {

// Monotone descent: sets that only ever decrease the sum of (1), from any set.

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

// A_SS is singular: along its null vector y does not move. The sum decreases there at the rate at which the entering
// point's violation is worked on. The way ends where another point of the set has no effort left. If none ever has, no
// p satisfies (1).
bool BoxSolver::slide(int entering) {
  find_null();
  side_[dropped_] = dropped_side_;
  double along = dropped_ == entering ? 1 : 0;
  for (int j = 0; j < rank_; ++j)
    if (set_[j] == entering) along = null_[j];
  const double sign = entering >= 0 && (along < 0) == (side_[entering] == Side::lower) ? -1 : 1;

  int leaving = -1;
  double step = infinity;
  const auto consider = [&](int i, double rate) {
    if (i == entering || (side_[i] == Side::lower ? rate >= 0 : rate <= 0)) return;
    const double until = -feasible_[i] / rate;
    if (until < step) {
      step = until;
      leaving = i;
    }
  };
  for (int j = 0; j < rank_; ++j) consider(set_[j], sign * null_[j]);
  consider(dropped_, sign);
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

namespace {

constexpr int most_iterations = 60;
constexpr double close_enough = 1e-12;

}  // namespace

int BoxInterior::solve(HeldBand& band, const Problem& problem) {
  start(band, problem);
  const double first = mean_work(0);
  int iteration = 0;
  for (; iteration < most_iterations; ++iteration) {
    const double work = mean_work(0);
    if (!(work > close_enough * first)) break;
    hold(band, problem);
    find_step(band, problem, 0, false);
    const double share = mean_work(length()) / work;
    find_step(band, problem, share * share * share * work, true);
    const double step = std::min(1.0, 0.995 * length());
    if (!(step > 1e-8)) break;
    move(step);
    measure(band, problem);
  }
  show(band, problem);
  return iteration;
}

// Efforts that would move each point by the deepest violation, and gaps of at least that.
void BoxInterior::start(HeldBand& band, const Problem& problem) {
  const auto points = static_cast<std::size_t>(problem.points);
  for (auto* v : {&measure_, &effort_, &compliance_, &right_, &step_, &moved_}) v->assign(points, 0.0);
  lower_.assign(points, {});
  upper_.assign(points, {});
  side_.assign(points, 0);
  for (std::size_t i = 0; i < points; ++i) {
    const double a = problem.reach * band.diagonal(static_cast<int>(i)) + problem.compliance[i];
    if (!(a > 0)) continue;
    if (problem.lower[i] > -infinity) lower_[i].effort = problem.depth / a;
    if (problem.upper[i] < infinity) upper_[i].effort = problem.depth / a;
    effort_[i] = lower_[i].effort - upper_[i].effort;
  }
  measure(band, problem);
  for (std::size_t i = 0; i < points; ++i) {
    lower_[i].gap = std::max(measure_[i] - problem.lower[i], problem.depth);
    upper_[i].gap = std::max(problem.upper[i] - measure_[i], problem.depth);
  }
}

void BoxInterior::measure(HeldBand& band, const Problem& problem) {
  band.multiply(effort_.data(), measure_.data());
  for (std::size_t i = 0; i < measure_.size(); ++i)
    measure_[i] = problem.free[i] + problem.reach * measure_[i] + problem.compliance[i] * effort_[i];
}

void BoxInterior::hold(HeldBand& band, const Problem& problem) {
  for (std::size_t i = 0; i < lower_.size(); ++i) {
    const double weight = lower_[i].weight() + upper_[i].weight();
    compliance_[i] = weight > 0 ? (problem.compliance[i] + 1 / weight) / problem.reach : infinity;
  }
  band.hold(compliance_.data());
}

// Newton towards a s = b t = target; `correct`: with what the step before, its predictor, leaves of second order.
void BoxInterior::find_step(HeldBand& band, const Problem& problem, double target, bool correct) {
  const auto push = [&](Stop& stop, double distance) {
    if (!stop.present()) return 0.0;
    const double second = correct ? stop.effort_step * stop.gap_step : 0.0;
    stop.wanted = (target - second) / stop.gap - stop.effort;
    return stop.wanted - stop.weight() * (distance - stop.gap);
  };
  for (std::size_t i = 0; i < lower_.size(); ++i) {
    const double weight = lower_[i].weight() + upper_[i].weight();
    const double pushes =
        push(lower_[i], measure_[i] - problem.lower[i]) - push(upper_[i], problem.upper[i] - measure_[i]);
    right_[i] = weight > 0 ? pushes / weight : 0.0;
  }
  band.solve(right_.data(), step_.data());
  for (double& step : step_) step /= problem.reach;
  band.multiply(step_.data(), moved_.data());
  const auto follow = [&](Stop& stop, double distance, double way) {
    if (!stop.present()) return;
    stop.gap_step = way + (distance - stop.gap);
    stop.effort_step = stop.wanted - stop.weight() * stop.gap_step;
  };
  for (std::size_t i = 0; i < lower_.size(); ++i) {
    const double way = problem.reach * moved_[i] + problem.compliance[i] * step_[i];
    follow(lower_[i], measure_[i] - problem.lower[i], way);
    follow(upper_[i], problem.upper[i] - measure_[i], -way);
  }
}

// The longest step, at most 1, that leaves gaps and efforts positive.
double BoxInterior::length() const {
  double step = 1;
  for (const auto* stops : {&lower_, &upper_})
    for (const Stop& stop : *stops) {
      if (!stop.present()) continue;
      if (stop.gap_step < 0) step = std::min(step, -stop.gap / stop.gap_step);
      if (stop.effort_step < 0) step = std::min(step, -stop.effort / stop.effort_step);
    }
  return step;
}

double BoxInterior::mean_work(double step) const {
  double sum = 0;
  int count = 0;
  for (const auto* stops : {&lower_, &upper_})
    for (const Stop& stop : *stops) {
      if (!stop.present()) continue;
      sum += (stop.gap + step * stop.gap_step) * (stop.effort + step * stop.effort_step);
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

void BoxInterior::move(double step) {
  for (std::size_t i = 0; i < lower_.size(); ++i) {
    for (Stop* stop : {&lower_[i], &upper_[i]}) {
      if (!stop->present()) continue;
      stop->gap += step * stop->gap_step;
      stop->effort += step * stop->effort_step;
    }
    effort_[i] = lower_[i].effort - upper_[i].effort;
  }
}

void BoxInterior::show(HeldBand& band, const Problem& problem) {
  for (std::size_t i = 0; i < lower_.size(); ++i) {
    const double a = problem.reach * band.diagonal(static_cast<int>(i)) + problem.compliance[i];
    const auto pushes = [&](const Stop& stop) { return stop.present() && a * stop.effort > stop.gap; };
    side_[i] = pushes(lower_[i]) ? 1 : pushes(upper_[i]) ? -1 : 0;
  }
}

}  // namespace ricochet
