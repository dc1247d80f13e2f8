#pragma once

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <ricochet/contact_solvers/box_problem.hpp>
#include <vector>

#include "tests/allocations.hpp"
#include "tests/eigen.hpp"

using namespace ricochet;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace box_problem_tests {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Columns final : DelassusColumns {
  explicit Columns(MatrixXd matrix) : W(std::move(matrix)), asked(static_cast<std::size_t>(W.cols()), 0) {}
  const double* column(int j) override {
    asked[static_cast<std::size_t>(j)] = 1;
    return W.data() + j * W.rows();
  }
  int touched() const { return static_cast<int>(std::count(asked.begin(), asked.end(), 1)); }
  MatrixXd W;
  std::vector<char> asked;
};

struct Problem {
  MatrixXd W;
  double reach = 1, compliance = 0;
  VectorXd free, lower, upper;
  int points() const { return static_cast<int>(free.size()); }
  MatrixXd A() const { return reach * W + compliance * MatrixXd::Identity(points(), points()); }
  VectorXd measure(const VectorXd& p) const { return free + A() * p; }
  // Deepest violation of the free measure: the length that errors are compared with.
  double depth() const { return std::max(0.0, std::max((lower - free).maxCoeff(), (free - upper).maxCoeff())); }
};

struct Solution {
  VectorXd p;
  LaneOutcome outcome;
};

inline Solution solve(const Problem& problem, VectorXd start = {}) {
  BoxSolver solver;
  solver.prepare(problem.points());
  Columns columns(problem.W);
  Solution s;
  s.p = start.size() > 0 ? start : VectorXd(VectorXd::Zero(problem.points()));
  s.outcome = solver.solve(columns, problem.reach, problem.compliance, problem.free.data(), problem.lower.data(),
                           problem.upper.data(), s.p.data(), problem.points());
  return s;
}

// The residual of the header, written from its formula.
inline double residual(const Problem& problem, const VectorXd& p) {
  const VectorXd y = problem.measure(p);
  double worst = 0;
  for (int i = 0; i < problem.points(); ++i) {
    const double a = problem.reach * problem.W(i, i) + problem.compliance;
    worst = std::max({worst, problem.lower[i] - y[i], y[i] - problem.upper[i],
                      std::min(a * std::max(p[i], 0.0), y[i] - problem.lower[i]),
                      std::min(a * std::max(-p[i], 0.0), problem.upper[i] - y[i])});
  }
  return worst;
}

// Tries all 3^m assignments of points to {free, lower, upper}; the best by residual.
inline VectorXd enumerate(const Problem& problem) {
  const int m = problem.points();
  const MatrixXd A = problem.A();
  VectorXd best = VectorXd::Zero(m);
  double least = infinity;
  const long patterns = std::lround(std::pow(3, m));
  for (long code = 0; code < patterns; ++code) {
    std::vector<int> set;
    VectorXd target(m);
    long rest = code;
    bool possible = true;
    for (int i = 0; i < m; ++i, rest /= 3) {
      if (rest % 3 == 0) continue;
      const double bound = rest % 3 == 1 ? problem.lower[i] : problem.upper[i];
      possible = possible && std::isfinite(bound);
      target[static_cast<int>(set.size())] = bound - problem.free[i];
      set.push_back(i);
    }
    if (!possible) continue;
    VectorXd p = VectorXd::Zero(m);
    if (!set.empty()) {
      const MatrixXd sub = A(set, set);
      const VectorXd efforts = eigen::ldlt_solve(sub, target.head(sub.rows()));
      p(set) = efforts;
    }
    // A pattern is right only with the signs that it says.
    rest = code;
    double wrong = 0;
    for (int i = 0; i < m; ++i, rest /= 3)
      if (rest % 3 != 0) wrong = std::max(wrong, A(i, i) * (rest % 3 == 1 ? -p[i] : p[i]));
    const double r = std::max(wrong, residual(problem, p));
    if (r < least) {
      least = r;
      best = p;
    }
  }
  return best;
}

inline VectorXd gauss_seidel(const Problem& problem, int sweeps) {
  const MatrixXd A = problem.A();
  VectorXd p = VectorXd::Zero(problem.points()), y = problem.free;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int i = 0; i < problem.points(); ++i) {
      const double alone = y[i] - A(i, i) * p[i];
      const double next = (std::max(0.0, problem.lower[i] - alone) - std::max(0.0, alone - problem.upper[i])) / A(i, i);
      y += A.col(i) * (next - p[i]);
      p[i] = next;
    }
  return p;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * uniform_(engine_); }
  bool chance(double probability) { return uniform_(engine_) < probability; }
  // Q diag(d) Qᵀ with d spread geometrically over `decades`.
  MatrixXd spd(int m, double decades) {
    const MatrixXd Q = eigen::orthogonal(MatrixXd::NullaryExpr(m, m, [&] { return (*this)(-1, 1); }));
    VectorXd d(m);
    for (int i = 0; i < m; ++i) d[i] = std::pow(10, -decades * i / std::max(1, m - 1));
    const MatrixXd W = Q * d.asDiagonal() * Q.transpose();
    return (W + W.transpose()) / 2;
  }
  // Two-sided bounds around random measures: a third violated below, a third above; some sides missing.
  Problem problem(int m, double decades) {
    Problem p;
    p.W = spd(m, decades);
    p.free = VectorXd::NullaryExpr(m, [&] { return (*this)(-1, 1); });
    p.lower.resize(m);
    p.upper.resize(m);
    for (int i = 0; i < m; ++i) {
      p.lower[i] = chance(0.2) ? -infinity : (*this)(-0.6, 0);
      p.upper[i] = chance(0.2) ? infinity : (*this)(0, 0.6);
    }
    return p;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

// What every answer must satisfy, whoever computed it: the header's tolerance, with its own definition of the residual.
// 1e-12 of the depth is what the solver promises; the rest is the round-off of forming y here, with at most 50 terms.
inline void check_complementarity(const Problem& problem, const Solution& s) {
  CHECK(s.outcome.converged);
  const VectorXd sizes = problem.A().diagonal().cwiseSqrt();
  const double terms = sizes.maxCoeff() * sizes.dot(s.p.cwiseAbs());
  const double tolerance = 1e-12 * problem.depth() + 64 * 51 * epsilon * (problem.free.cwiseAbs().maxCoeff() + terms);
  CHECK(residual(problem, s.p) <= tolerance);
  CHECK(s.outcome.residual <= tolerance);
}

inline MatrixXd cantilever(int m) {
  MatrixXd W(m, m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = double(std::min(i, j) + 1) / m, b = double(std::max(i, j) + 1) / m;
      W(i, j) = a * a * (3 * b - a) / 6;
    }
  return W;
}

// Uniform load q towards a flat stop at distance 1 above, EI = L = 1: y° = q x²(6 − 4x + x²)/24.
inline Problem loaded_cantilever(int m, double q) {
  Problem p;
  p.W = cantilever(m);
  p.free = VectorXd::NullaryExpr(m, [&](Eigen::Index i) {
    const double x = double(i + 1) / m;
    return q * x * x * (6 - 4 * x + x * x) / 24;
  });
  p.lower = VectorXd::Constant(m, -infinity);
  p.upper = VectorXd::Constant(m, 1.0);
  return p;
}

}  // namespace box_problem_tests
