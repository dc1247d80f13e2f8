// What a person writes for a tube in modes between two-sided stops: modes by rows, the points' flexibility once, rigid
// stops by projected Gauss–Seidel, springs by the set of points that push and one factorisation. No audit, no record.
#include "tests/benchmarks/fair_tube.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/benchmarks/hold_between.hpp"
#include "tests/benchmarks/thread_clock.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ricochet::benchmarks::FairTube;
using ricochet::benchmarks::FairTubeResult;
using ricochet::benchmarks::hold_between;
using ricochet::benchmarks::thread_nanoseconds;

constexpr int most_points = 16;
using Set = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_points, most_points>;
using Efforts = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_points, 1>;

// λ of springs behind the gap: points that push are looked for until they stay the same.
void press(const MatrixXd& W, double gap, double stiffness, const Efforts& free, Efforts& effort) {
  Efforts place = free;
  int pushed[most_points], before[most_points], count = 0, last = -1;
  for (int round = 0; round < 30; ++round) {
    count = 0;
    for (int i = 0; i < place.size(); ++i)
      if (std::abs(place[i]) > gap) pushed[count++] = i;
    if (count == last && std::equal(pushed, pushed + count, before)) break;
    std::copy_n(pushed, count, before);
    last = count;
    Set S(count, count);
    Efforts over(count);
    for (int i = 0; i < count; ++i) {
      const double u = free[pushed[i]];
      over[i] = (u > 0 ? gap : -gap) - u;
      for (int j = 0; j < count; ++j) S(i, j) = W(pushed[i], pushed[j]) + (i == j ? 1 / stiffness : 0);
    }
    over = S.llt().solve(over);
    effort.setZero();
    for (int i = 0; i < count; ++i) effort[pushed[i]] = over[i];
    place = free + W * effort;
  }
}

}  // namespace

FairTubeResult ricochet_fair_tube(const FairTube& scene, long long steps) {
  const int n = scene.modes, points = scene.points;
  const double h = scene.h;
  VectorXd p(n), q(n), inverse(n);
  for (int k = 0; k < n; ++k) {
    const double a = 1 / (h * h) + scene.damping[k] / (2 * h) + scene.squares[k] / 2;
    inverse[k] = 1 / a;
    p[k] = 2 / (h * h) / a;
    q[k] = -(1 / (h * h) - scene.damping[k] / (2 * h) + scene.squares[k] / 2) / a;
  }
  const MatrixXd shapes =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(scene.shapes, points, n);
  const MatrixXd moved = inverse.asDiagonal() * shapes.transpose(), W = shapes * moved;
  const VectorXd load = inverse.cwiseProduct(Eigen::Map<const VectorXd>(scene.load, n));
  VectorXd u = VectorXd::Zero(n), before = u, next(n);
  Efforts place = Efforts::Zero(points), effort = place;
  FairTubeResult out;
  double now = 0, last = scene.force * std::sin(-scene.pulsation * h);
  double following = 0;
  const double begun = thread_nanoseconds();
  for (long long k = 0; k < steps; ++k) {
    following = scene.force * std::sin(scene.pulsation * static_cast<double>(k + 1) * h);
    next = p.cwiseProduct(u) + q.cwiseProduct(before) + 0.5 * (following + last) * load;
    last = now;
    now = following;
    place.noalias() = shapes * next;
    if ((place.array().abs() > scene.gap).any()) {
      scene.stiffness > 0 ? press(W, scene.gap, scene.stiffness, place, effort)
                          : hold_between(W, scene.gap, place, effort);
      next.noalias() += moved * effort;
      out.impulse += h * effort.lpNorm<1>();
      ++out.pushed;
    } else {
      effort.setZero();
    }
    before.swap(u);
    u.swap(next);
  }
  out.step_seconds = 1e-9 * (thread_nanoseconds() - begun) / static_cast<double>(steps);
  out.end = shapes.row(points - 1).dot(u);
  return out;
}
