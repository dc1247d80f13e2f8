#pragma once

// The force law recomputed at each answer, on random operators.
#include <ricochet/contact_solvers/pointwise_solver.hpp>

#include "tests/contact_solvers/box_problems.hpp"

using namespace ricochet;

namespace pointwise_solver_tests {
using Eigen::MatrixXd;
using Eigen::VectorXd;

using box_problem_tests::Columns, box_problem_tests::epsilon, box_problem_tests::infinity;

/// p = k δⁿ (1 + χ δ̇)₊, stiffness growing from lane to lane.
struct Power final : PointwiseLaw {
  double k = 1, n = 1, chi = 0;
  PointForce force(const ContactState& s) const override {
    if (!(s.depth > 0)) return {};
    const double factor = std::max(0.0, 1 + chi * s.rate), p = k * std::pow(s.depth, n);
    return {p * factor, n * p / s.depth * factor, factor > 0 ? chi * p : 0.0, 0, 0};
  }
};

/// A dashpot that is there or not: p = (k δ + c δ̇)₊ for δ > 0 jumps at entry.
struct Dashpot final : PointwiseLaw {
  double k = 1, c = 1;
  PointForce force(const ContactState& s) const override {
    const double p = k * s.depth + c * s.rate;
    if (!(s.depth > 0) || !(p > 0)) return {};
    return {p, k, c, 0, c * s.rate * s.rate};
  }
};

/// U = −k δ² ln(1 − δ/D): no depth reaches D.
struct Barrier final : PointwiseLaw {
  double k = 1, D = 0.1;
  PointForce force(const ContactState& s) const override {
    if (!(s.depth > 0)) return {};
    if (s.depth >= D) return {infinity, infinity, 0, 0, 0};
    const double r = 1 - s.depth / D, l = std::log(r);
    return {k * (s.depth * s.depth / (D * r) - 2 * s.depth * l),
            k * (s.depth * s.depth / (D * D * r * r) + 4 * s.depth / (D * r) - 2 * l), 0, 0, 0};
  }
};

struct Problem {
  MatrixXd W;
  double reach = 1, rate_reach = 0;
  VectorXd free, rate, lower, upper;
  int points() const { return static_cast<int>(free.size()); }
};

struct Solution {
  VectorXd p;
  LaneOutcome outcome;
  std::vector<ContactSlopes> slopes;
};

inline Solution solve(const PointwiseLaw& law, const Problem& problem, VectorXd start = {}, int newton = 60) {
  const int m = problem.points();
  PointwiseSolver solver;
  solver.prepare(m, 1);
  solver.limit(newton, 4000);
  Columns columns(problem.W);
  Solution s;
  s.p = start.size() > 0 ? start : VectorXd(VectorXd::Zero(m));
  ReducedProblem reduced;
  reduced.points = m;
  reduced.lanes = 1;
  reduced.delassus = &columns;
  reduced.reach = problem.reach;
  reduced.rate_reach = problem.rate_reach;
  reduced.free = problem.free.data();
  reduced.rate_free = problem.rate.data();
  reduced.lower = problem.lower.data();
  reduced.upper = problem.upper.data();
  reduced.effort = s.p.data();
  s.outcome = solver.solve(law, reduced, 0);
  for (int i = 0; i < m; ++i) s.slopes.push_back(solver.slopes(i, 0));
  return s;
}

// p − F(y(p), u(p)), and the size of what it is made of.
struct Error {
  double wrong = 0, size = 0;
};
inline Error error(const PointwiseLaw& law, const Problem& problem, const VectorXd& p) {
  const VectorXd moved = problem.W * p;
  const VectorXd y = problem.free + problem.reach * moved, u = problem.rate + problem.rate_reach * moved;
  const VectorXd terms = problem.W.cwiseAbs() * p.cwiseAbs();
  Error worst;
  for (int i = 0; i < problem.points(); ++i) {
    const PointForce low = law.force({problem.lower[i] - y[i], -u[i], 0, i, 0}),
                     high = law.force({y[i] - problem.upper[i], u[i], 0, i, 0});
    const double wrong = std::abs(p[i] - (low.value - high.value));
    if (!std::isfinite(wrong)) return {infinity, infinity};
    double bound = 0;
    for (const double b : {problem.lower[i], problem.upper[i]})
      if (std::isfinite(b)) bound = std::max(bound, std::abs(b));
    const double size =
        std::abs(p[i]) +
        (low.stiffness + high.stiffness) * (std::abs(problem.free[i]) + bound + problem.reach * terms[i]) +
        (low.viscosity + high.viscosity) * (std::abs(problem.rate[i]) + problem.rate_reach * terms[i]);
    if (wrong > 64 * epsilon * size) worst = {std::max(worst.wrong, wrong), std::max(worst.size, size)};
  }
  return worst;
}

class Random : public box_problem_tests::Random {
 public:
  using box_problem_tests::Random::Random;
  Problem problem(int m, double decades) {
    Problem p;
    p.W = spd(m, decades);
    p.reach = (*this)(0.1, 2);
    p.rate_reach = (*this)(0, 2);
    p.free = VectorXd::NullaryExpr(m, [&] { return (*this)(-1, 1); });
    p.rate = VectorXd::NullaryExpr(m, [&] { return (*this)(-1, 1); });
    p.lower = VectorXd::NullaryExpr(m, [&] { return (*this)(0, 1) < 0.2 ? -infinity : (*this)(-0.6, 0); });
    p.upper = VectorXd::NullaryExpr(m, [&] { return (*this)(0, 1) < 0.2 ? infinity : (*this)(0, 0.6); });
    return p;
  }
};

}  // namespace pointwise_solver_tests
