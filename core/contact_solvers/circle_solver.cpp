#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ricochet/contact_solvers/circle_solver.hpp>
#include <ricochet/kernels/floating_point.hpp>
#include <utility>

namespace ricochet {
namespace {

constexpr int most_frames = 200;
// Of a direction, in units of what its numbers lose.
constexpr double direction_round_off = 16 * std::numeric_limits<double>::epsilon();
// A direction that turns by less and does not settle any more has settled.
constexpr double settled = 1e-11;

double dot(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  return a[0] * b[0] + a[1] * b[1];
}

}  // namespace

double StopCircle::distance(double u1, double u2) const {
  return std::hypot(u1 - centre[0], u2 - centre[1]);
}

double StopCircle::outwards(double u1, double u2, double v1, double v2) const {
  const double rho = distance(u1, u2);
  return rho > 0 ? ((u1 - centre[0]) * v1 + (u2 - centre[1]) * v2) / rho : 0.0;
}

std::array<double, 2> StopCircle::square(int axis) const {
  const double half = radius * (0.5 * std::numbers::sqrt2), middle = centre[static_cast<std::size_t>(axis)];
  return {middle - half, middle + half};
}

void CircleSolver::prepare(int points, int lanes, std::vector<int> circles, int memory) {
  circles_ = std::move(circles);
  if (circles_.empty()) return;
  points_ = points;
  lanes_ = lanes;
  kept_ = memory;
  const auto m = static_cast<std::size_t>(points), count = circles_.size();
  circle_of_.assign(m, -1);
  for (std::size_t c = 0; c < count; ++c)
    for (const int axis : {0, 1}) circle_of_[static_cast<std::size_t>(circles_[c] + axis)] = static_cast<int>(c);
  frames_.assign(count, {});
  for (auto* block : {&free_, &lower_, &upper_, &rate_, &before_, &effort_})
    block->assign(m * static_cast<std::size_t>(lanes), 0.0);
  memory_.assign(m * static_cast<std::size_t>(memory), 0.0);
  place_.assign(count, {});
  next_.assign(count, {});
  push_.assign(m, 0.0);
  columns_ = std::make_unique_for_overwrite<double[]>(m * m);
  known_.assign(m, 0);
  springs_.reserve(count);
  across_.assign(count * m, 0.0);
  share_.assign(count * count, 0.0);
  for (auto* numbers : {&give_, &held_, &radial_}) numbers->assign(count, 0.0);
  found_.assign(2 * count, 0.0);
}

// Column j of W between rows in the frames.
const double* CircleSolver::turned_column(int j, double* to) {
  const int c = circle_of_[static_cast<std::size_t>(j)];
  if (c < 0) {
    std::copy_n(lane_.delassus->column(j), points_, to);
  } else {
    const Frame& frame = frames_[static_cast<std::size_t>(c)];
    const int first = circles_[static_cast<std::size_t>(c)];
    const std::array<double, 2>& way = j == first ? frame.n : frame.t;
    const double *one = lane_.delassus->column(first), *other = lane_.delassus->column(first + 1);
    for (int i = 0; i < points_; ++i) to[i] = way[0] * one[i] + way[1] * other[i];
  }
  for (std::size_t d = 0; d < circles_.size(); ++d) {
    double* pair = to + circles_[d];
    const std::array<double, 2> was = {pair[0], pair[1]};
    pair[0] = dot(frames_[d].n, was);
    pair[1] = dot(frames_[d].t, was);
  }
  return to;
}

const double* CircleSolver::Turned::column(int j) {
  CircleSolver& all = solver_;
  const auto m = static_cast<std::size_t>(all.points_), k = all.springs_.size();
  double* to = all.columns_.get() + static_cast<std::size_t>(j) * m;
  if (std::exchange(all.known_[static_cast<std::size_t>(j)], 1) != 0) return to;
  all.turned_column(j, to);
  if (k == 0) return to;
  // − η W_B G W_Bj
  for (std::size_t s = 0; s < k; ++s) all.give_[s] = all.across_[s * m + static_cast<std::size_t>(j)];
  all.solve_springs(all.give_.data());
  for (std::size_t s = 0; s < k; ++s) {
    const double by = all.lane_.reach * all.give_[s];
    const double* column = all.across_.data() + s * m;
    for (std::size_t i = 0; i < m; ++i) to[i] -= by * column[i];
  }
  return to;
}

// The frame of a circle whose point stands at a place.
void CircleSolver::turn(std::size_t circle, const std::array<double, 2>& place) {
  Frame& frame = frames_[circle];
  const std::array<double, 2> from = {place[0] - frame.circle.centre[0], place[1] - frame.circle.centre[1]};
  const double rho = std::hypot(from[0], from[1]);
  std::array<double, 2> sum = from;
  frame.distance = rho;
  if (means_) {
    const int first = circles_[circle];
    const std::array<double, 2> was = {lane_.before[first] - frame.circle.centre[0],
                                       lane_.before[first + 1] - frame.circle.centre[1]};
    frame.before = std::hypot(was[0], was[1]);
    for (const std::size_t axis : {0, 1}) sum[axis] += was[axis];
    frame.distance += frame.before;
  }
  frame.n = {frame.distance > 0 ? sum[0] / frame.distance : 1.0, frame.distance > 0 ? sum[1] / frame.distance : 0.0};
  const double length = std::hypot(frame.n[0], frame.n[1]);
  frame.t = {length > 0 ? -frame.n[1] / length : 0.0, length > 0 ? frame.n[0] / length : 1.0};
  frame.shift = means_ ? rho - dot(frame.n, from) : 0.0;
}

// x ← (Λ⁻¹ + ηW_BB)⁻¹ x by the factors that condense() left.
void CircleSolver::solve_springs(double* x) const {
  const std::size_t k = springs_.size(), row = circles_.size();
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j < i; ++j) x[i] -= share_[i * row + j] * x[j];
  for (std::size_t i = k; i-- > 0;) {
    x[i] /= share_[i * row + i];
    for (std::size_t j = i + 1; j < k; ++j) x[i] -= share_[j * row + i] * x[j];
  }
}

// The springs along t of the circles that push: their columns, and L D Lᵀ of what they answer by.
void CircleSolver::condense() {
  std::fill(known_.begin(), known_.end(), static_cast<unsigned char>(0));
  springs_.clear();
  const auto m = static_cast<std::size_t>(points_);
  for (std::size_t c = 0; c < circles_.size(); ++c)
    if (lane_.reach > 0 && frames_[c].across > 0) {
      turned_column(circles_[c] + 1, across_.data() + springs_.size() * m);
      springs_.push_back(static_cast<int>(c));
    }
  const std::size_t k = springs_.size(), row = circles_.size();
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double* column = across_.data() + i * m;
      double entry = lane_.reach * column[circles_[static_cast<std::size_t>(springs_[j])] + 1];
      if (i == j) entry += 1 / frames_[static_cast<std::size_t>(springs_[i])].across;
      for (std::size_t l = 0; l < j; ++l) entry -= share_[i * row + l] * share_[j * row + l] * share_[l * row + l];
      share_[i * row + j] = i == j ? entry : entry / share_[j * row + j];
    }
}

// What the law sees of the lane.
void CircleSolver::put_frames() {
  const auto at = [&](int i) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_) + number_; };
  for (int i = 0; i < points_; ++i) {
    if (circle_of_[static_cast<std::size_t>(i)] >= 0) continue;
    free_[at(i)] = lane_.free[i];
    lower_[at(i)] = lane_.lower[i];
    upper_[at(i)] = lane_.upper[i];
    if (lane_.rate_free) rate_[at(i)] = lane_.rate_free[i];
    if (means_) before_[at(i)] = lane_.before[i];
  }
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    const Frame& frame = frames_[c];
    const int first = circles_[c];
    const auto in = [&](const std::array<double, 2>& vector, std::vector<double>& block) {
      block[at(first)] = dot(frame.n, vector);
      block[at(first + 1)] = dot(frame.t, vector);
    };
    in({lane_.free[first] - frame.circle.centre[0], lane_.free[first + 1] - frame.circle.centre[1]}, free_);
    free_[at(first)] += frame.shift;
    if (lane_.rate_free) in({lane_.rate_free[first], lane_.rate_free[first + 1]}, rate_);
    if (means_) before_[at(first)] = frame.before;
    lower_[at(first)] = lower_[at(first + 1)] = -infinity;
    upper_[at(first)] = frame.circle.radius;
    upper_[at(first + 1)] = infinity;
  }
  const std::size_t k = springs_.size(), m = static_cast<std::size_t>(points_);
  // From where the frame stands.
  for (std::size_t s = 0; s < k; ++s) {
    const auto c = static_cast<std::size_t>(springs_[s]);
    held_[s] = dot(frames_[c].t, {lane_.free[circles_[c]] - place_[c][0], lane_.free[circles_[c] + 1] - place_[c][1]});
  }
  std::copy_n(held_.data(), k, give_.data());
  solve_springs(give_.data());
  for (std::size_t s = 0; s < k; ++s)
    for (int i = 0; i < points_; ++i) {
      const double by = give_[s] * across_[s * m + static_cast<std::size_t>(i)];
      free_[at(i)] -= lane_.reach * by;
      if (lane_.rate_free) rate_[at(i)] -= lane_.rate_reach * by;
    }
}

// The law's efforts in the frames, and with the springs along t those along u₁ and u₂.
void CircleSolver::call(ContactLaw& law, ReducedProblem& problem) {
  const auto at = [&](int i) { return static_cast<std::size_t>(i) * static_cast<std::size_t>(lanes_) + number_; };
  for (int which = 0; which < kept_; ++which)
    for (int i = 0; i < points_; ++i)
      problem.memory_of(static_cast<int>(number_), which)[i] = memory_[static_cast<std::size_t>(which * points_ + i)];
  for (int i = 0; i < points_; ++i) effort_[at(i)] = push_[static_cast<std::size_t>(i)];
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    const std::array<double, 2> p = {push_[static_cast<std::size_t>(circles_[c])],
                                     push_[static_cast<std::size_t>(circles_[c] + 1)]};
    effort_[at(circles_[c])] = std::min(dot(frames_[c].n, p), 0.0);
    effort_[at(circles_[c] + 1)] = 0;
  }
  Turned turned(*this);
  const int one = static_cast<int>(number_);
  ReducedProblem framed = problem;
  framed.delassus = &turned;
  framed.free = free_.data();
  framed.lower = lower_.data();
  framed.upper = upper_.data();
  framed.rate_free = problem.rate_free ? rate_.data() : nullptr;
  framed.before = problem.before ? before_.data() : nullptr;
  framed.effort = effort_.data();
  framed.touched = {&one, 1};
  law.solve(framed);
  const std::size_t k = springs_.size(), m = static_cast<std::size_t>(points_);
  for (std::size_t s = 0; s < k; ++s) {
    give_[s] = held_[s];
    for (int i = 0; i < points_; ++i)
      if (const double p = effort_[at(i)]; p != 0)
        give_[s] += lane_.reach * across_[s * m + static_cast<std::size_t>(i)] * p;
  }
  solve_springs(give_.data());
  for (int i = 0; i < points_; ++i) push_[static_cast<std::size_t>(i)] = effort_[at(i)];
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    radial_[c] = effort_[at(circles_[c])];
    for (const std::size_t axis : {0, 1})
      push_[static_cast<std::size_t>(circles_[c]) + axis] = frames_[c].n[axis] * radial_[c];
  }
  for (std::size_t s = 0; s < k; ++s) {
    const auto c = static_cast<std::size_t>(springs_[s]);
    for (const std::size_t axis : {0, 1})
      push_[static_cast<std::size_t>(circles_[c]) + axis] -= frames_[c].t[axis] * give_[s];
  }
}

// Where the efforts move the points of circles.
void CircleSolver::move() {
  for (std::size_t c = 0; c < circles_.size(); ++c) next_[c] = {lane_.free[circles_[c]], lane_.free[circles_[c] + 1]};
  for (int j = 0; j < points_; ++j) {
    const double p = lane_.reach * push_[static_cast<std::size_t>(j)];
    if (p == 0) continue;
    const double* column = lane_.delassus->column(j);
    for (std::size_t c = 0; c < circles_.size(); ++c)
      for (const std::size_t axis : {0, 1}) next_[c][axis] += p * column[static_cast<std::size_t>(circles_[c]) + axis];
  }
}

// How far directions of circles that push turn on, and what of it is no round-off.
CircleSolver::Turn CircleSolver::turn_on(double share) {
  Turn most;
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    Frame& frame = frames_[c];
    const std::array<double, 2> n = frame.n;
    const double shift = frame.shift;
    // A spring along t of a circle that lets go is none.
    const bool pulls = radial_[c] == 0 && frame.across > 0;
    for (const std::size_t axis : {0, 1}) place_[c][axis] += share * (next_[c][axis] - place_[c][axis]);
    const double rho = frame.circle.distance(next_[c][0], next_[c][1]);
    const bool pushes = radial_[c] != 0 || rho > frame.circle.radius;
    turn(c, next_[c]);
    const double angle = pulls ? 1.0
                               : std::max(std::hypot(frame.n[0] - n[0], frame.n[1] - n[1]),
                                          std::abs(frame.shift - shift) / frame.distance);
    const int first = circles_[c];
    const double lost =
        direction_round_off * (1 + (std::abs(lane_.free[first]) + std::abs(lane_.free[first + 1]) +
                                    std::abs(frame.circle.centre[0]) + std::abs(frame.circle.centre[1])) /
                                       frame.distance);
    if (pushes || pulls) {
      most.angle = std::max(most.angle, angle);
      most.beyond = std::max(most.beyond, angle - lost);
      most.way = std::max(most.way, angle * rho);
    }
    if (share < 1) turn(c, place_[c]);
    frame.across = frame.distance > 0 ? -radial_[c] / frame.distance : 0;
  }
  return most;
}

void CircleSolver::solve_lane(ContactLaw& law, ReducedProblem& problem) {
  lane_ = problem.lane(static_cast<int>(number_));
  means_ = static_cast<bool>(lane_.before);
  for (int which = 0; which < kept_; ++which)
    for (int i = 0; i < points_; ++i)
      memory_[static_cast<std::size_t>(which * points_ + i)] = problem.memory_of(static_cast<int>(number_), which)[i];
  for (int i = 0; i < points_; ++i) push_[static_cast<std::size_t>(i)] = lane_.effort[i];
  move();
  for (std::size_t c = 0; c < circles_.size(); ++c) {
    Frame& frame = frames_[c];
    frame.circle = StopCircle::of(lane_.lower, lane_.upper, circles_[c]);
    place_[c] = next_[c];
    turn(c, place_[c]);
    const auto first = static_cast<std::size_t>(circles_[c]);
    frame.across = frame.distance > 0 ? std::hypot(push_[first], push_[first + 1]) / frame.distance : 0;
  }
  LaneOutcome& outcome = problem.outcome[number_];
  int iterations = 0;
  double share = 1, last = infinity;
  for (int frame = 0;; ++frame) {
    condense();
    put_frames();
    call(law, problem);
    iterations += outcome.iterations;
    outcome.iterations = iterations;
    for (std::size_t c = 0; c < circles_.size(); ++c)
      for (const std::size_t axis : {0, 1}) found_[2 * c + axis] = frames_[c].n[axis] * radial_[c];
    if (!outcome.converged || lane_.reach == 0) break;
    move();
    const Turn turned = turn_on(share);
    if (turned.beyond <= 0 || (turned.angle <= settled && turned.angle >= 0.5 * last)) {
      outcome.residual = std::max(outcome.residual, turned.way);
      break;
    }
    if (frame == most_frames) {
      outcome.converged = false;
      outcome.residual = turned.way;
      break;
    }
    share = turned.angle > last ? 0.5 * share : std::min(1.0, 2 * share);
    last = turned.angle;
  }
  for (int i = 0; i < points_; ++i)
    if (circle_of_[static_cast<std::size_t>(i)] < 0) lane_.effort[i] = push_[static_cast<std::size_t>(i)];
  for (std::size_t c = 0; c < circles_.size(); ++c)
    for (const int axis : {0, 1}) lane_.effort[circles_[c] + axis] = found_[2 * c + static_cast<std::size_t>(axis)];
}

void CircleSolver::solve(ContactLaw& law, ReducedProblem& problem) {
  if (!any()) return law.solve(problem);
  for (const int lane : problem.touched) {
    number_ = static_cast<std::size_t>(lane);
    solve_lane(law, problem);
  }
}

}  // namespace ricochet
