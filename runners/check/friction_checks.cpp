#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "runners/check/allocation_count.hpp"
#include "runners/check/checks.hpp"

/// \file
/// What is looked at in a friction law, by problems of one and five points with one and two rows each.
namespace ricochet::checking {
namespace {

using Friction = Subject<FrictionLaw>;

// One lane of one stage, and what the law answers.
struct Rubbed {
  Eigen::MatrixXd A;
  Eigen::VectorXd free, effort;
  std::vector<double> bound, slid, remembered, remembers;
  std::vector<int> first = {0};
  std::vector<unsigned char> sticks;
  double h = 1e-3;
  long long allocations = 0;
  LaneOutcome outcome;

  Rubbed(int points, int rows, int kept)
      : A(Eigen::MatrixXd::Identity(points * rows, points * rows)),
        free(Eigen::VectorXd::Zero(points * rows)),
        effort(free),
        bound(static_cast<std::size_t>(points), 1.0),
        slid(bound),
        remembered(static_cast<std::size_t>(points * rows * kept), 0.0),
        remembers(remembered),
        sticks(static_cast<std::size_t>(points)) {
    for (int i = 1; i <= points; ++i) first.push_back(i * rows);
  }
  int points() const { return static_cast<int>(bound.size()); }
  int rows() const { return static_cast<int>(free.size()); }
  Eigen::VectorXd rate() const { return free + A * effort; }
  Eigen::VectorXd of(const Eigen::VectorXd& x, int point) const {
    const auto i = static_cast<std::size_t>(point);
    return x.segment(first[i], first[i + 1] - first[i]);
  }
  void solve(FrictionLaw& law) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_rows = A;
    FrictionProblem problem;
    problem.points = points();
    problem.first_row = first.data();
    problem.matrix = by_rows.data();
    problem.stride = rows();
    problem.free = free.data();
    problem.bound = problem.bound_static = bound.data();
    problem.h = h;
    problem.remembered = remembered.data();
    problem.remembers = remembers.data();
    problem.effort = effort.data();
    problem.sticks = sticks.data();
    problem.slid = slid.data();
    const long long before = allocations_of_this_thread();
    outcome = law.solve(problem);
    allocations = allocations_of_this_thread() - before;
  }
};

Rubbed drawn(std::mt19937& random, const FrictionLaw& law, int points, int rows) {
  std::uniform_real_distribution<double> any(-1, 1);
  Rubbed one(points, rows, law.memory_per_row());
  const Eigen::MatrixXd B = Eigen::MatrixXd::NullaryExpr(points * rows, points * rows, [&] { return any(random); });
  one.A = 1e-3 * (B.transpose() * B + 0.1 * Eigen::MatrixXd::Identity(points * rows, points * rows));
  one.free = Eigen::VectorXd::NullaryExpr(points * rows, [&] { return 1e-2 * any(random); });
  for (double& s : one.bound) s = std::pow(10, 2 * any(random));
  return one;
}

// A verdict over problems of all sizes; `wrong` says what one of them shows, or "".
Verdict everywhere(const Friction& subject,
                   std::string (*wrong)(FrictionLaw& law, std::mt19937& random, int points, int rows)) {
  std::mt19937 random(5);
  for (const int points : {1, 5})
    for (const int rows : {1, 2}) {
      const auto law = subject.make();
      law->prepare(points, points * rows);
      for (int k = 0; k < 60; ++k)
        if (std::string why = wrong(*law, random, points, rows); !why.empty())
          return fails(fmt::format("with {} point{} of {} row{}: {}", points, points == 1 ? "" : "s", rows,
                                   rows == 1 ? "" : "s", why));
    }
  return fine();
}

Verdict manual(const Friction& subject) {
  return manual_complete(subject.entry->manual);
}

Verdict within_disc(const Friction& subject) {
  return everywhere(subject, [](FrictionLaw& law, std::mt19937& random, int points, int rows) -> std::string {
    Rubbed one = drawn(random, law, points, rows);
    if (random() % 4 == 0) one.bound[0] = 0;
    one.solve(law);
    if (!one.outcome.converged) return "it does not converge";
    for (int i = 0; i < points; ++i) {
      const double s = one.bound[static_cast<std::size_t>(i)], p = one.of(one.effort, i).norm();
      if (!(p <= s * (1 + 1e-12))) return fmt::format("|p| = {:.6g} N beyond the bound {:.6g} N", p, s);
    }
    return "";
  });
}

Verdict takes_energy(const Friction& subject) {
  return everywhere(subject, [](FrictionLaw& law, std::mt19937& random, int points, int rows) -> std::string {
    Rubbed one = drawn(random, law, points, rows);
    const int kept = law.memory_per_row();
    const auto stored = [&](const std::vector<double>& memory) {
      double sum = 0;
      for (int i = 0; kept > 0 && i < one.rows(); ++i)
        sum += law.stored(memory.data() + static_cast<std::ptrdiff_t>(i) * kept);
      return sum;
    };
    for (int step = 0; step < 3; ++step) {
      one.solve(law);
      const Eigen::VectorXd u = one.rate();
      // Rates are differences: round-off of what they are made of.
      const double size = one.effort.norm() * (one.free.norm() + (one.A * one.effort).norm());
      const double heat = -one.h * one.effort.dot(u) - (stored(one.remembers) - stored(one.remembered));
      if (!(heat >= -1e-12 * one.h * size)) return fmt::format("it gives {:.3g} J in a stage", -heat);
      one.remembered = one.remembers;
      one.free = -0.7 * one.free;
    }
    return "";
  });
}

Verdict knows_no_direction(const Friction& subject) {
  return everywhere(subject, [](FrictionLaw& law, std::mt19937& random, int points, int rows) -> std::string {
    Rubbed one = drawn(random, law, points, rows), turned = one;
    const double angle = 0.7;
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(points * rows, points * rows);
    for (int i = 0; i < points; ++i)
      if (rows == 1)
        R(i, i) = -1;
      else
        R.block(2 * i, 2 * i, 2, 2) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    turned.A = R * one.A * R.transpose();
    turned.free = R * one.free;
    one.solve(law);
    turned.solve(law);
    const double off = (turned.effort - R * one.effort).norm(),
                 size = *std::max_element(one.bound.begin(), one.bound.end());
    return off <= 1e-9 * size ? ""
                              : fmt::format("the turned problem has another effort, by {:.3g} N of {:.3g}", off, size);
  });
}

// What it says of sticking and sliding beside the motion that its effort leaves. A law that neither creeps nor gives
// way sticks within its bound, and slides by all of the velocity.
std::string wrong_slip(const FrictionLaw& law, const Rubbed& one) {
  const bool exact = law.creeps(0.97) == 0 && law.gives_way() == 0;
  const Eigen::VectorXd u = one.rate();
  for (int i = 0; i < one.points(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double slid = one.slid[at], moves = one.of(u, i).norm(), push = one.of(one.effort, i).norm();
    if (!(slid >= 0)) return fmt::format("a point slides at {:.3g} m/s, below 0", slid);
    if (one.sticks[at] != 0 && slid != 0) return "a point that sticks slides";
    constexpr double within = 0.99, tolerance = 1e-6, floor = 1e-9;
    if (!exact) continue;
    if (one.sticks[at] == 0 && std::abs(slid - moves) > tolerance * moves + floor)
      return fmt::format("a point moves at {:.6g} m/s, and slides at {:.6g} by what it says", moves, slid);
    if (one.sticks[at] == 0 && push < within * one.bound[at])
      return fmt::format("a point is held by {:.3g} of its bound, and does not stick by what it says",
                         push / one.bound[at]);
  }
  return "";
}

Verdict finds_one_effort(const Friction& subject) {
  return everywhere(subject, [](FrictionLaw& law, std::mt19937& random, int points, int rows) -> std::string {
    Rubbed one = drawn(random, law, points, rows), other = one;
    other.effort.setConstant(0.3);
    one.solve(law);
    other.solve(law);
    if (one.allocations + other.allocations > 0) return "solve() allocates";
    const double off = (one.effort - other.effort).norm(), size = *std::max_element(one.bound.begin(), one.bound.end());
    if (!(off <= 1e-9 * size))
      return fmt::format("another first guess gives another effort, by {:.3g} N of {:.3g}", off, size);
    Rubbed again = one;
    again.effort.setZero();
    Rubbed twice = again;
    again.solve(law);
    twice.solve(law);
    if (again.effort != twice.effort) return "the same problem gives other bits";
    return wrong_slip(law, again);
  });
}

// A unit mass after so many steps.
struct Pulled {
  double velocity = 0, place = 0, slides = 0;  ///< what the law says of the last step
};

// Under `load` times its bound, steps of 1 ms.
Pulled pulled(FrictionLaw& law, double load, int steps) {
  Rubbed one(1, 1, law.memory_per_row());
  one.A(0, 0) = one.h;
  double v = 0, x = 0;
  for (int n = 0; n < steps; ++n) {
    one.free[0] = v + one.h * load;
    one.solve(law);
    v = one.rate()[0];
    x += one.h * v;
    one.remembered = one.remembers;
  }
  return {v, x, one.slid[0]};
}

Verdict holds_and_slides(const Friction& subject) {
  const auto law = subject.make();
  law->prepare(1, 1);
  constexpr int steps = 20000;
  const double held = pulled(*law, 0.97, steps).velocity, declared = law->creeps(0.97);
  if (!(std::abs(held) <= declared * (1 + 1e-6) + 1e-9))
    return fails(
        fmt::format("a mass held by 0.97 of its bound drifts at {:.3g} m/s, and creeps() says {:.3g}", held, declared));
  // Of a bound of 1 N, which the swing that a sudden load begins does not reach.
  constexpr double load = 0.3;
  const double way = pulled(*law, load, steps).place, declared_way = load * law->gives_way();
  if (declared == 0 && !(std::abs(way - declared_way) <= 1e-3 * declared_way + 1e-12))
    return fails(
        fmt::format("a mass held by {} N gives way by {:.3g} m, and gives_way() says {:.3g}", load, way, declared_way));
  const Pulled early = pulled(*law, 1.1, steps / 2), late = pulled(*law, 1.1, steps);
  const double acceleration = (late.velocity - early.velocity) / (0.5 * steps * 1e-3);
  if (!(std::abs(acceleration - 0.1) <= 1e-3))
    return fails(
        fmt::format("a mass pulled by 1.1 of its bound accelerates by {:.4g} of it; expected 0.1", acceleration));
  if (!(std::abs(late.slides - late.velocity) <= 1e-2 * late.velocity))
    return fails(
        fmt::format("a mass that slides at {:.4g} m/s slides at {:.4g} by what it says", late.velocity, late.slides));
  return fine();
}

}  // namespace

const std::vector<Check<FrictionLaw>>& friction_checks() {
  static const std::vector<Check<FrictionLaw>> checks = {{"manual", manual},
                                                         {"effort within its bound", within_disc},
                                                         {"takes energy, never gives", takes_energy},
                                                         {"no direction is special", knows_no_direction},
                                                         {"one effort, found without memory", finds_one_effort},
                                                         {"holds and slides", holds_and_slides}};
  return checks;
}

std::vector<CheckResult> check_friction(const Entry<FrictionLaw>& entry, const Isolation& isolation) {
  return run_checks(friction_checks(), entry, isolation);
}

}  // namespace ricochet::checking
