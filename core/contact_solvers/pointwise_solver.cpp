#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <ricochet/contact_solvers/pointwise_solver.hpp>
#include <ricochet/kernels/floating_point.hpp>

namespace ricochet {
namespace {

// Round-off of a number that a few operations made, relative to its terms.
constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();

// A force that answers this little to what it moves is as good as given.
constexpr double least_answer = 1e-15;

// The slope of E may turn upwards by this much of what it was: E still falls.
constexpr double overshoot = 0.1;
constexpr int most_halvings = 50;

// Halvings of the doubles between 0 and any number, and as many Newton steps.
constexpr int most_point_steps = 2200;

}  // namespace

bool PointwiseSolver::Answer::finite() const {
  return std::isfinite(force) && std::isfinite(stiffness) && std::isfinite(viscosity);
}

void PointwiseSolver::prepare(int points, int lanes, bool per_point) {
  assert(points >= 0 && lanes >= 0);
  points_ = points;
  lanes_ = lanes;
  per_point_ = per_point;
  const auto m = static_cast<std::size_t>(points);
  for (auto* v : {&effort_, &moved_, &terms_, &step_, &shift_, &right_, &root_}) v->assign(m, 0.0);
  factor_.assign(m * m, 0.0);
  set_.assign(m, 0);
  column_.assign(m, nullptr);
  answer_.assign(m, {});
  slopes_.assign(m * static_cast<std::size_t>(lanes), {});
}

// D: how much the force of a point falls per x.
double PointwiseSolver::Lane::weight(const Answer& answer) const {
  return problem.reach * answer.stiffness + problem.rate_reach * answer.viscosity;
}

PointwiseSolver::Answer PointwiseSolver::Lane::answer(int i, double x) const {
  const std::size_t k = at(i);
  const double y = problem.free[k] + problem.reach * x;
  const double u = problem.rate_free ? problem.rate_free[k] + problem.rate_reach * x : 0.0;
  Answer sum;
  const auto add = [&](int side, double bound) {
    const double depth = side * (bound - y), before = problem.before ? side * (bound - problem.before[k]) : 0.0;
    if (!(depth > 0 || before > 0)) return;
    const PointForce force =
        law.force({depth, -side * u, before, i, lane, per_point ? static_cast<int>(k) : lane, side});
    sum.force += side * force.value;
    sum.stiffness += std::max(force.stiffness, 0.0);
    sum.viscosity += std::max(force.viscosity, 0.0);
    sum.before += force.before;
    sum.dissipation += force.dissipation;
    sum.bound = std::max(sum.bound, std::abs(bound));
  };
  add(1, problem.lower[k]);
  add(-1, problem.upper[k]);
  return sum;
}

// Of F, through the numbers that it is made of.
double PointwiseSolver::Lane::round_off(int i, double terms, double p, const Answer& answer) const {
  if (!answer.finite()) return 0;
  const std::size_t k = at(i);
  double sum = std::abs(p) + std::abs(answer.force);
  sum += answer.stiffness * (std::abs(problem.free[k]) + answer.bound + problem.reach * terms);
  if (problem.rate_free) sum += answer.viscosity * (std::abs(problem.rate_free[k]) + problem.rate_reach * terms);
  if (problem.before) sum += std::abs(answer.before) * (std::abs(problem.before[k]) + answer.bound);
  return rounding * sum;
}

// Of x.
double PointwiseSolver::Lane::slack(int i, double terms, const Answer& answer) const {
  const std::size_t k = at(i);
  double sum = terms;
  if (problem.reach > 0) sum += (std::abs(problem.free[k]) + answer.bound) / problem.reach;
  if (problem.rate_free && problem.rate_reach > 0) sum += std::abs(problem.rate_free[k]) / problem.rate_reach;
  return rounding * sum;
}

// Whether p is what the law says, or lies between the ends of a jump.
bool PointwiseSolver::Lane::on_law(int i, double x, double terms, double p, const Answer& answer) const {
  const double near = round_off(i, terms, p, answer);
  if (std::abs(p - answer.force) <= near) return true;
  const double width = slack(i, terms, answer), p_off = rounding * std::abs(p);
  return this->answer(i, x - width).force >= p - p_off && this->answer(i, x + width).force <= p + p_off;
}

// The dissipation at a p between the ends of a jump, linear in p between those of the ends. It is not that of the end
// on which round-off has put x.
double PointwiseSolver::Lane::dissipation_between(int i, double x, double terms, double p, const Answer& at) const {
  const double width = slack(i, terms, at);
  const Answer before = answer(i, x - width), after = answer(i, x + width);
  const double jump = before.force - after.force;
  if (!(jump > 0)) return at.dissipation;
  const double share = std::clamp((p - after.force) / jump, 0.0, 1.0);
  return share * before.dissipation + (1 - share) * after.dissipation;
}

// p = F(others + mobility·p): the left grows with p, the right falls, 0 and F(others) stand to either side.
double PointwiseSolver::solve_point(const Lane& lane, int i, double others, double mobility, double guess) {
  const Answer still = lane.answer(i, others);
  if (still.force == 0 || mobility == 0 || std::isnan(still.force)) return still.force;
  const double side = still.force > 0 ? 1 : -1;
  double low = 0, high = std::abs(still.force), last = infinity;
  double p = side * guess;
  if (!(p > low && p < high)) p = high / (1 + lane.weight(still) * mobility);
  if (!std::isfinite(p)) p = 1;
  for (int step = 0; step < most_point_steps; ++step) {
    const double moved = others + mobility * (side * p);
    if (!std::isfinite(moved)) return side * infinity;  // no effort moves the point to where the law is finite
    const Answer now = lane.answer(i, moved);
    double wrong = p - side * now.force;
    if (std::isnan(wrong)) return wrong;
    if (std::abs(wrong) <= lane.round_off(i, std::abs(others) + mobility * p, p, now)) return side * p;
    (wrong < 0 ? low : high) = p;
    double next = p - wrong / (1 + lane.weight(now) * mobility);
    // Newton falls by more than half where it works at all.
    const bool slow = !(std::abs(wrong) < 0.5 * last);
    if (high == infinity)
      next = 4 * p;
    else if (slow || !(next > low && next < high))
      next = low + 0.5 * (high - low);
    last = slow ? infinity : std::abs(wrong);
    if (next == p || next == low || next == high) return side * high;
    p = next;
  }
  return side * p;
}

// The measures of the present efforts and what the law answers.
void PointwiseSolver::move(const Lane& lane) {
  const int m = lane.problem.points;
  std::fill_n(moved_.begin(), m, 0.0);
  std::fill_n(terms_.begin(), m, 0.0);
  for (int j = 0; j < m; ++j) {
    const double p = effort_[j];
    if (p == 0) continue;
    const double* column = lane.problem.delassus->column(j);
    for (int i = 0; i < m; ++i) {
      moved_[i] += column[i] * p;
      terms_[i] += std::abs(column[i] * p);
    }
  }
  for (int i = 0; i < m; ++i) answer_[i] = lane.answer(i, moved_[i]);
}

bool PointwiseSolver::settled(const Lane& lane) const {
  for (int i = 0; i < lane.problem.points; ++i)
    if (!(std::abs(effort_[i] - answer_[i].force) <= lane.round_off(i, terms_[i], effort_[i], answer_[i])))
      return false;
  return true;
}

// (3): points that do not answer take their force, the others share the rest by I + √D W √D = L Lᵀ.
bool PointwiseSolver::find_direction(const Lane& lane) {
  const int m = lane.problem.points;
  int count = 0;
  std::fill_n(shift_.begin(), m, 0.0);
  const auto shift_by = [&](const double* column, double step) {
    for (int i = 0; i < m; ++i) shift_[i] += column[i] * step;
  };
  for (int i = 0; i < m; ++i) {
    const double weight = lane.weight(answer_[i]);
    step_[i] = answer_[i].force - effort_[i];
    const double* column = weight > 0 || step_[i] != 0 ? lane.problem.delassus->column(i) : nullptr;
    if (weight > 0 && weight * column[i] > least_answer) {
      set_[count] = i;
      column_[count] = column;
      root_[count++] = std::sqrt(weight);
    } else if (step_[i] != 0) {
      shift_by(column, step_[i]);
    }
  }
  const auto row_length = static_cast<std::size_t>(points_);
  for (int a = 0; a < count; ++a) {
    const int i = set_[a];
    double* row = factor_.data() + static_cast<std::size_t>(a) * row_length;
    double sum = step_[i] / root_[a] - root_[a] * shift_[i];
    for (int b = 0; b <= a; ++b) {
      const double* earlier = factor_.data() + static_cast<std::size_t>(b) * row_length;
      double entry = root_[a] * column_[a][set_[b]] * root_[b] + (a == b ? 1.0 : 0.0);
      for (int t = 0; t < b; ++t) entry -= row[t] * earlier[t];
      // No pivot of I and a positive semidefinite matrix is below 1.
      row[b] = a == b ? std::sqrt(std::max(entry, 1.0)) : entry / earlier[b];
    }
    for (int b = 0; b < a; ++b) sum -= row[b] * right_[b];
    right_[a] = sum / row[a];
  }
  for (int a = count; a-- > 0;) {
    const double* row = factor_.data() + static_cast<std::size_t>(a) * row_length;
    right_[a] /= row[a];
    for (int b = 0; b < a; ++b) right_[b] -= row[b] * right_[a];
    step_[set_[a]] = root_[a] * right_[a];
    if (!std::isfinite(step_[set_[a]])) return false;
  }
  for (int a = 0; a < count; ++a) shift_by(column_[a], step_[set_[a]]);
  return true;
}

// (2) after a part of the step.
double PointwiseSolver::slope(const Lane& lane, double step) const {
  double sum = 0;
  for (int i = 0; i < lane.problem.points; ++i) {
    if (shift_[i] == 0) continue;
    const double force = lane.answer(i, moved_[i] + step * shift_[i]).force;
    sum += shift_[i] * (effort_[i] + step * step_[i] - force);
  }
  return sum;
}

bool PointwiseSolver::newton(const Lane& lane, int& iterations) {
  const int m = lane.problem.points;
  for (int iteration = 0; iteration < most_iterations_; ++iteration) {
    move(lane);
    for (int i = 0; i < m; ++i)
      if (!answer_[i].finite()) return false;
    if (settled(lane)) return true;
    ++iterations;
    if (!find_direction(lane)) return false;
    const double before = slope(lane, 0);
    double step = 1;
    int halvings = 0;
    while (!(slope(lane, step) <= overshoot * std::abs(before))) {
      if (++halvings > most_halvings) return false;
      step *= 0.5;
    }
    for (int i = 0; i < m; ++i) effort_[i] += step * step_[i];
  }
  return false;
}

// Gauss–Seidel: the minimum of E along one effort after the other.
bool PointwiseSolver::sweep(const Lane& lane, int& iterations) {
  const int m = lane.problem.points;
  for (int i = 0; i < m; ++i)
    if (!std::isfinite(effort_[i])) effort_[i] = 0;
  for (int turn = 0; turn < most_sweeps_; ++turn) {
    move(lane);
    bool right = true;
    for (int i = 0; i < m && right; ++i) right = lane.on_law(i, moved_[i], terms_[i], effort_[i], answer_[i]);
    if (right) return true;
    ++iterations;
    for (int i = 0; i < m; ++i) {
      if (effort_[i] == 0 && lane.answer(i, moved_[i]).force == 0) continue;
      const double* column = lane.problem.delassus->column(i);
      const double p = solve_point(lane, i, moved_[i] - column[i] * effort_[i], column[i], effort_[i]);
      if (!std::isfinite(p)) return false;
      const double change = p - effort_[i];
      effort_[i] = p;
      if (change == 0) continue;
      for (int j = 0; j < m; ++j) moved_[j] += column[j] * change;
    }
  }
  return false;
}

LaneOutcome PointwiseSolver::finish(const Lane& lane, bool converged, int iterations) {
  const ReducedProblem& problem = lane.problem;
  LaneOutcome outcome{converged, iterations, 0};
  for (int i = 0; i < problem.points; ++i) {
    const Answer& answer = answer_[i];
    const double p = effort_[i], wrong = std::abs(p - answer.force);
    const bool bridged = converged && wrong > lane.round_off(i, terms_[i], p, answer);
    outcome.dissipation += bridged ? lane.dissipation_between(i, moved_[i], terms_[i], p, answer) : answer.dissipation;
    slopes_[static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane.lane)] = {
        answer.stiffness, answer.viscosity, answer.before};
    if (wrong == 0) continue;
    if (!std::isfinite(wrong)) {
      outcome.residual = infinity;
      continue;
    }
    const double mobility = problem.delassus->column(i)[i];
    // By how much the measure, or where no effort moves it the depth, is off.
    double apart = wrong / (1 + lane.weight(answer) * mobility);
    if (problem.reach > 0)
      apart = problem.reach * (bridged ? lane.slack(i, terms_[i], answer) : mobility * apart);
    else
      apart = answer.stiffness > 0 && !bridged ? apart / answer.stiffness : 0.0;
    outcome.residual = std::isnan(apart) ? infinity : std::max(outcome.residual, apart);
  }
  if (!std::isfinite(outcome.residual)) outcome = {false, iterations, infinity};
  for (int i = 0; i < problem.points; ++i) problem.effort[lane.at(i)] = outcome.converged ? effort_[i] : 0.0;
  return outcome;
}

// Nothing that p could move: F as it stands.
LaneOutcome PointwiseSolver::solve_known(const Lane& lane) {
  bool any = false, finite = true;
  for (int i = 0; i < lane.problem.points; ++i) {
    effort_[i] = answer_[i].force;
    any = any || effort_[i] != 0;
    finite = finite && std::isfinite(effort_[i]);
  }
  return finish(lane, finite, any ? 1 : 0);
}

LaneOutcome PointwiseSolver::solve_alone(const Lane& lane) {
  const double* column = lane.problem.delassus->column(0);
  effort_[0] = solve_point(lane, 0, 0, column[0], effort_[0]);
  const bool finite = std::isfinite(effort_[0]);
  if (!finite) effort_[0] = 0;
  move(lane);
  return finish(lane, finite && lane.on_law(0, moved_[0], terms_[0], effort_[0], answer_[0]), 1);
}

LaneOutcome PointwiseSolver::solve_coupled(const Lane& lane) {
  int iterations = 0;
  const bool found = newton(lane, iterations) || sweep(lane, iterations);
  return finish(lane, found, iterations);
}

LaneOutcome PointwiseSolver::solve(const PointwiseLaw& law, ReducedProblem& problem, int lane_number) {
  const int m = problem.points;
  assert(m >= 0 && m <= points_ && lane_number >= 0 && lane_number < lanes_);
  const Lane lane{law, problem, lane_number, per_point_};
  bool finite = true, pushed = false;
  for (int i = 0; i < m; ++i) {
    const std::size_t k = lane.at(i);
    finite = finite && std::isfinite(problem.free[k]) && (!problem.rate_free || std::isfinite(problem.rate_free[k])) &&
             (!problem.before || std::isfinite(problem.before[k]));
    effort_[i] = std::isfinite(problem.effort[k]) ? problem.effort[k] : 0.0;
    moved_[i] = terms_[i] = 0;
    answer_[i] = lane.answer(i, 0);
    pushed = pushed || answer_[i].force != 0;
  }
  if (!finite) {
    for (int i = 0; i < m; ++i) problem.effort[lane.at(i)] = 0;
    return {false, 0, infinity};
  }
  if (!pushed || (problem.reach == 0 && problem.rate_reach == 0)) return solve_known(lane);
  return m == 1 ? solve_alone(lane) : solve_coupled(lane);
}

}  // namespace ricochet
