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

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

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

Solution solve(const Problem& problem, VectorXd start = {}) {
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
double residual(const Problem& problem, const VectorXd& p) {
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
VectorXd enumerate(const Problem& problem) {
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

VectorXd gauss_seidel(const Problem& problem, int sweeps) {
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
void check_complementarity(const Problem& problem, const Solution& s) {
  CHECK(s.outcome.converged);
  const VectorXd sizes = problem.A().diagonal().cwiseSqrt();
  const double terms = sizes.maxCoeff() * sizes.dot(s.p.cwiseAbs());
  const double tolerance = 1e-12 * problem.depth() + 64 * 51 * epsilon * (problem.free.cwiseAbs().maxCoeff() + terms);
  CHECK(residual(problem, s.p) <= tolerance);
  CHECK(s.outcome.residual <= tolerance);
}

MatrixXd cantilever(int m) {
  MatrixXd W(m, m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = double(std::min(i, j) + 1) / m, b = double(std::max(i, j) + 1) / m;
      W(i, j) = a * a * (3 * b - a) / 6;
    }
  return W;
}

// Uniform load q towards a flat stop at distance 1 above, EI = L = 1: y° = q x²(6 − 4x + x²)/24.
Problem loaded_cantilever(int m, double q) {
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

}  // namespace

TEST_CASE("the effort is the one of enumeration", "[box]") {
  Random random(1);
  for (int m = 1; m <= 8; ++m)
    for (int repeat = 0; repeat < (m <= 6 ? 40 : 3); ++repeat) {
      Problem problem = random.problem(m, 2);
      if (repeat % 3 == 1) problem.compliance = random(1e-3, 10);
      if (repeat % 3 == 2) problem.reach = random(0.1, 5);
      INFO("m " << m << " repeat " << repeat);
      const Solution s = solve(problem);
      check_complementarity(problem, s);
      const VectorXd expected = enumerate(problem);
      // Condition 100 at most: two stable solves of one system differ by 100·m·ε, with a margin of ten.
      CHECK((s.p - expected).norm() <= 1e4 * m * epsilon * (1 + expected.norm()));
    }
}

TEST_CASE("an ill-conditioned operator still gives the measure of enumeration", "[box]") {
  Random random(2);
  for (int m = 2; m <= 6; ++m)
    for (int repeat = 0; repeat < 30; ++repeat) {
      const Problem problem = random.problem(m, 10);
      INFO("m " << m << " repeat " << repeat);
      const Solution s = solve(problem);
      check_complementarity(problem, s);
      const VectorXd expected = enumerate(problem);
      // Efforts grow like the condition 1e10 and cancel in A p: only y is well defined, to their size times ε. Moving
      // the data by δ moves y by up to √(condition)·δ where a point enters or leaves.
      CHECK((problem.measure(s.p) - problem.measure(expected)).cwiseAbs().maxCoeff() <=
            1e5 * 100 * epsilon * (1 + expected.norm()));
    }
}

TEST_CASE("m = 50 agrees with projected Gauss-Seidel", "[box]") {
  Random random(3);
  for (int repeat = 0; repeat < 6; ++repeat) {
    Problem problem = random.problem(50, 2);
    if (repeat % 2 == 1) problem.compliance = 0.1;
    const Solution s = solve(problem);
    check_complementarity(problem, s);
    const VectorXd expected = gauss_seidel(problem, 4000);
    // Gauss-Seidel contracts by about 1 − 1/condition per sweep: 4000 sweeps at condition 100 leave e^-40, below ε.
    CHECK((s.p - expected).norm() <= 1e-10 * expected.norm());
  }
}

TEST_CASE("an open lane has no effort and asks for no column", "[box]") {
  Problem problem = Random(4).problem(12, 1);
  problem.free.setZero();
  Columns columns(problem.W);
  BoxSolver solver;
  solver.prepare(12);
  VectorXd p = VectorXd::Ones(12);
  const LaneOutcome outcome =
      solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 12);
  CHECK(outcome.converged);
  CHECK(p == VectorXd::Zero(12));
  CHECK(columns.touched() == 0);
}

TEST_CASE("one candidate is the closed form and asks for one column", "[box]") {
  const MatrixXd W = Random(5).spd(50, 1);
  for (const double side : {1.0, -1.0}) {
    Problem problem{W, 0.5, 0.25, VectorXd::Zero(50), VectorXd::Constant(50, -10), VectorXd::Constant(50, 10)};
    problem.free[17] = side * 10.5;
    Columns columns(W);
    BoxSolver solver;
    solver.prepare(50);
    VectorXd p = VectorXd::Zero(50);
    const LaneOutcome outcome =
        solver.solve(columns, 0.5, 0.25, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 50);
    CHECK(outcome.converged);
    CHECK(outcome.iterations == 1);
    CHECK(columns.touched() == 1);
    CHECK(p[17] == -side * 0.5 / (0.5 * W(17, 17) + 0.25));
    CHECK((p.array() != 0).count() == 1);
  }
}

TEST_CASE("columns are asked for only at points of the sets tried", "[box]") {
  // Two groups that do not see each other: the second stays open and is never asked for.
  Random random(6);
  Problem problem{MatrixXd::Zero(40, 40),   1, 0, VectorXd::Zero(40), VectorXd::Constant(40, -1),
                  VectorXd::Constant(40, 1)};
  problem.W.topLeftCorner(20, 20) = random.spd(20, 2);
  problem.W.bottomRightCorner(20, 20) = random.spd(20, 2);
  problem.free.head(20).setConstant(-1.5);
  Columns columns(problem.W);
  BoxSolver solver;
  solver.prepare(40);
  VectorXd p = VectorXd::Zero(40);
  CHECK(solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 40)
            .converged);
  CHECK(columns.touched() <= 20);
}

TEST_CASE("one point alone", "[box]") {
  const MatrixXd W = MatrixXd::Constant(1, 1, 4);
  const auto one = [&](double free, double lower, double upper, double compliance, double reach = 0.5) {
    const Problem problem{
        W, reach, compliance, VectorXd::Constant(1, free), VectorXd::Constant(1, lower), VectorXd::Constant(1, upper)};
    return solve(problem, VectorXd::Constant(1, 3.0));
  };
  CHECK(one(-3, -1, 1, 0).p[0] == 1);
  CHECK(one(3, -1, 1, 2).p[0] == -0.5);
  CHECK(one(0, -1, 1, 0).p[0] == 0);
  CHECK(one(-3, -infinity, 1, 0).p[0] == 0);
  CHECK(one(-3, -1, 1, 2, 0).p[0] == 1);
  CHECK(one(5, 2, 2, 0).p[0] == -1.5);
  CHECK_FALSE(one(-3, -1, 1, 0, 0).outcome.converged);
  CHECK(one(-3, -1, 1, 0, 0).outcome.residual == 2);
}

TEST_CASE("a bound that is met without effort, exactly", "[box]") {
  // W = [2 1; 1 2]: the effort that brings point 0 to its stop leaves point 1 on its own stop, with p = 0.
  Problem problem{(MatrixXd(2, 2) << 2, 1, 1, 2).finished(), 1, 0, Eigen::Vector2d(-2, 0), Eigen::Vector2d(0, 1),
                  Eigen::Vector2d(infinity, infinity)};
  for (const auto& start : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Eigen::Vector2d(0, 1)}) {
    const Solution s = solve(problem, start);
    CHECK(s.outcome.converged);
    CHECK(s.p == Eigen::Vector2d(1, 0));
  }
}

TEST_CASE("degenerate contacts: every point ends on its stop, some by chance", "[box]") {
  Random random(7);
  for (int repeat = 0; repeat < 60; ++repeat) {
    const int m = 2 + repeat % 7;
    Problem problem = random.problem(m, repeat % 2 == 0 ? 1 : 6);
    // y° chosen so that y = lower everywhere, with p > 0 at every second point only.
    VectorXd p(m);
    for (int i = 0; i < m; ++i) {
      p[i] = i % 2 == 0 ? random(0.1, 1) : 0;
      problem.lower[i] = random(-1, 0);
      problem.upper[i] = random.chance(0.5) ? problem.lower[i] + 1 : infinity;
    }
    problem.free = problem.lower - problem.A() * p;
    INFO("m " << m << " repeat " << repeat);
    const Solution s = solve(problem, VectorXd::Ones(m));
    check_complementarity(problem, s);
    // A degenerate p is fixed by y alone, to round-off over the smallest eigenvalue, 10⁻¹ or 10⁻⁶.
    CHECK((s.p - p).norm() <= 1e3 * epsilon * (repeat % 2 == 0 ? 1e1 : 1e6) * (1 + p.norm()));
  }
}

TEST_CASE("lower = upper is an equality, of either sign", "[box]") {
  Random random(8);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Problem problem = random.problem(6, 3);
    problem.lower = problem.upper = VectorXd::NullaryExpr(6, [&] { return random(-1, 1); });
    const Solution s = solve(problem);
    check_complementarity(problem, s);
    const VectorXd expected = eigen::ldlt_solve(problem.A(), problem.lower - problem.free);
    // Condition 1000, two stable solves.
    CHECK((s.p - expected).norm() <= 1e5 * epsilon * expected.norm());
  }
}

TEST_CASE("an explicit evaluation is each point on its own", "[box]") {
  Problem problem = Random(9).problem(20, 2);
  problem.reach = 0;
  problem.compliance = 1e-5;
  Columns columns(problem.W);
  BoxSolver solver;
  solver.prepare(20);
  VectorXd p = VectorXd::Ones(20);
  CHECK(solver.solve(columns, 0, 1e-5, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 20)
            .converged);
  CHECK(columns.touched() == 0);
  for (int i = 0; i < 20; ++i) {
    const double f = problem.free[i];
    CHECK(p[i] == (f < problem.lower[i]   ? (problem.lower[i] - f) / 1e-5
                   : f > problem.upper[i] ? (problem.upper[i] - f) / 1e-5
                                          : 0.0));
  }
}

TEST_CASE("units do not matter: powers of two change nothing but the exponent", "[box]") {
  Random random(10);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Problem problem = random.problem(20, repeat);
    const Solution s = solve(problem);
    for (const double length : {0x1p-60, 0x1p40})
      for (const double reach : {0x1p-80, 0x1p80}) {
        Problem scaled = problem;
        scaled.reach *= reach;
        scaled.free *= length;
        scaled.lower *= length;
        scaled.upper *= length;
        const Solution t = solve(scaled);
        CHECK(t.outcome.iterations == s.outcome.iterations);
        CHECK(t.p * (reach / length) == s.p);
      }
  }
}

TEST_CASE("a cantilever pressed onto a flat stop", "[box]") {
  // reference: tip only for 8 < q < 72 with R = 3q/8 − 3; beyond, contact on [b, 1], b = (72/q)^¼, with the force q b/3
  // at b and q on [b, 1].
  for (const int m : {10, 50}) {
    const Solution open = solve(loaded_cantilever(m, 7.9));
    CHECK(open.p == VectorXd::Zero(m));
    const Solution tip = solve(loaded_cantilever(m, 40));
    // One active point: exact to the round-off of y° and the closed form.
    CHECK(tip.p[m - 1] == Approx(-(3 * 40 / 8.0 - 3)).epsilon(1e-13));
    CHECK((tip.p.array() != 0).count() == 1);
    const double q = 72 * 16;  // b = 1/2
    const Problem problem = loaded_cantilever(m, q);
    const Solution flat = solve(problem);
    check_complementarity(problem, flat);
    // The force at b spreads over a mesh length 1/m, the total follows with that error.
    CHECK(-flat.p.sum() == Approx(q / 6 + q / 2).epsilon(1.0 / m));
    for (int i = 0; i < m; ++i)
      if ((i + 1.0) / m < 0.5 - 1.0 / m) CHECK(flat.p[i] == 0);
  }
}

TEST_CASE("nearly singular: hundreds of nodes of a cantilever between two stops", "[box]") {
  // Condition 1e9 and more: efforts lose nine digits, complementarity none.
  Random random(11);
  for (int repeat = 0; repeat < 12; ++repeat) {
    const int m = repeat < 8 ? 50 : 200;
    Problem problem = loaded_cantilever(m, 0);
    problem.lower.setConstant(-0.1);
    problem.upper.setConstant(0.1);
    for (int k = 1; k <= 6; ++k) {
      const double amplitude = random(-1, 1);
      for (int i = 0; i < m; ++i) problem.free[i] += amplitude * std::sin((k - 0.5) * M_PI * (i + 1.0) / m);
    }
    if (repeat % 4 == 3)
      for (int i = 0; i < m; ++i) problem.free[i] += random(-0.01, 0.01);
    INFO("m " << m << " repeat " << repeat);
    const Solution s = solve(problem);
    check_complementarity(problem, s);
    // Each point enters or leaves a few times at most; pivoting by least index needs over 10⁵ sets here.
    CHECK(s.outcome.iterations <= 32 + 5 * m);
  }
}

TEST_CASE("the plain active set can cycle, descent does not", "[box]") {
  // Found by search over small integer matrices: symmetric positive definite, not an M-matrix, stop at zero below.
  struct Case {
    MatrixXd W;
    VectorXd free;
  };
  const Case cases[] = {
      {(MatrixXd(3, 3) << 27, 24, -21, 24, 22, -18, -21, -18, 19).finished(), Eigen::Vector3d(-3, -1, 3)},
      {(MatrixXd(3, 3) << 9, -10, 15, -10, 13, -15, 15, -15, 27).finished(), Eigen::Vector3d(2, -3, 2)},
      {(MatrixXd(4, 4) << 13, -11, 5, -10, -11, 10, -2, 8, 5, -2, 11, -7, -10, 8, -7, 10).finished(),
       Eigen::Vector4d(-2, 2, 1, -1)}};
  for (const auto& c : cases) {
    const long m = c.free.size();
    const Problem problem{c.W, 1, 0, c.free, VectorXd::Zero(m), VectorXd::Constant(m, infinity)};
    REQUIRE(eigen::values(c.W).minCoeff() > 0);
    BoxSolver plain;
    plain.prepare(static_cast<int>(m));
    plain.limit_descent(0);
    Columns columns(c.W);
    VectorXd p = VectorXd::Zero(m);
    const LaneOutcome stuck = plain.solve(columns, 1, 0, problem.free.data(), problem.lower.data(),
                                          problem.upper.data(), p.data(), static_cast<int>(m));
    CHECK_FALSE(stuck.converged);
    CHECK(stuck.iterations < 10);
    // The best iterate comes with its own residual.
    CHECK(stuck.residual == Approx(residual(problem, p)));

    const Solution s = solve(problem);
    check_complementarity(problem, s);
    // Condition below 1000 and integers below 30.
    CHECK((s.p - enumerate(problem)).norm() <= 1e-12);
  }
}

TEST_CASE("hard random operators never defeat descent", "[box]") {
  // Far from M-matrices: G Gᵀ with G of small integers, singular now and then.
  Random random(12);
  int solved = 0;
  for (int repeat = 0; repeat < 3000; ++repeat) {
    const int m = 3 + repeat % 10;
    const MatrixXd G = MatrixXd::NullaryExpr(m, m, [&] { return std::round(random(-3.5, 3.5)); });
    Problem problem{G * G.transpose(), 1, 0, {}, VectorXd::Zero(m), VectorXd::Constant(m, infinity)};
    if (problem.W.diagonal().minCoeff() == 0) continue;
    // y° in the image of W plus bounds: a solution always exists, also when W is singular.
    const VectorXd p = VectorXd::NullaryExpr(m, [&] { return std::max(0.0, std::round(random(-3, 3))); });
    problem.free = -problem.W * p;
    for (int i = 0; i < m; ++i)
      if (p[i] == 0) problem.free[i] += std::round(random(0, 3));
    if (repeat % 2 == 0) problem.upper = VectorXd::NullaryExpr(m, [&](Eigen::Index i) { return p[i] > 0 ? 1 : 9.0; });
    const Solution s = solve(problem);
    INFO("repeat " << repeat << " m " << m);
    check_complementarity(problem, s);
    ++solved;
  }
  // A point that nothing moves is rare among small integers.
  CHECK(solved > 2900);
}

TEST_CASE("two contact points at one place", "[box]") {
  Random random(13);
  for (int repeat = 0; repeat < 60; ++repeat) {
    const int base = 2 + repeat % 4, m = base + 2;
    Problem single = random.problem(base, 2);
    Problem twice;
    // Points 0 and base − 1 appear again at the end, their stops the same, or open a little further.
    std::vector<int> origin(static_cast<std::size_t>(m));
    for (int i = 0; i < base; ++i) origin[static_cast<std::size_t>(i)] = i;
    origin[static_cast<std::size_t>(base)] = 0;
    origin[static_cast<std::size_t>(base) + 1] = base - 1;
    twice.W = single.W(origin, origin);
    twice.free = single.free(origin);
    twice.lower = single.lower(origin);
    twice.upper = single.upper(origin);
    if (repeat % 3 > 0) {
      // The first of the pair is the one that lies behind: the choice by lowest index is wrong here.
      const double further = repeat % 3 == 1 ? 0.05 : 1e-9;
      twice.lower[0] -= further;
      twice.upper[base - 1] += further;
    }
    INFO("repeat " << repeat);
    const Solution s = solve(twice), expected = solve(single);
    check_complementarity(twice, s);
    VectorXd shared = s.p.head(base);
    shared[0] += s.p[base];
    shared[base - 1] += s.p[base + 1];
    // The sum of the pair is the effort of the single point, to a residual of 1e-12 times the condition 100.
    CHECK((shared - expected.p).norm() <= 1e-10 * (1 + expected.p.norm()));
  }
}

TEST_CASE("a rigid bar on more supports than it needs", "[box]") {
  // Rank 2, m supports: the efforts are not unique, their resultants are.
  for (int m = 3; m <= 12; ++m) {
    MatrixXd H(m, 2);
    for (int i = 0; i < m; ++i) H.row(i) << 1, 2.0 * i / (m - 1) - 1;
    for (const double tilt : {0.0, 0.3, -0.9}) {
      const Eigen::Vector2d fall(-1, tilt);
      Problem problem{H * H.transpose(), 1, 0, H * fall, VectorXd::Zero(m), VectorXd::Constant(m, infinity)};
      const Solution s = solve(problem);
      INFO("m " << m << " tilt " << tilt);
      check_complementarity(problem, s);
      CHECK(s.p.minCoeff() >= 0);
      // All supports touched: the bar is at rest on them, H(fall + Hᵀp) = 0 determines Hᵀp = −fall.
      CHECK((H.transpose() * s.p + fall).norm() <= 1e-11);
    }
  }
}

TEST_CASE("a point that nothing can move, and stops that contradict each other", "[box]") {
  Problem problem{MatrixXd::Zero(3, 3),    1, 0, Eigen::Vector3d(-2, -2, 0), Eigen::Vector3d(-1, -1, -1),
                  Eigen::Vector3d(1, 1, 1)};
  problem.W(1, 1) = 2;
  const Solution stuck = solve(problem);
  CHECK_FALSE(stuck.outcome.converged);
  CHECK(stuck.outcome.residual == 1);
  CHECK(stuck.p == Eigen::Vector3d(0, 0.5, 0));

  problem.free[0] = 0;
  CHECK(solve(problem).outcome.converged);

  // One place, first to stay above 1, then below 0.
  const Problem clash{MatrixXd::Ones(2, 2),        1, 0, Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(1, -infinity),
                      Eigen::Vector2d(infinity, 0)};
  const Solution none = solve(clash);
  CHECK_FALSE(none.outcome.converged);
  // Nothing does better than halfway.
  CHECK(none.outcome.residual >= 0.5);
  CHECK(std::isfinite(none.p.sum()));
}

TEST_CASE("data that are not finite are said, not passed on", "[box]") {
  for (const int m : {1, 5}) {
    const Problem good{MatrixXd::Identity(m, m), 1, 0, VectorXd::Constant(m, -2), VectorXd::Constant(m, -1),
                       VectorXd::Constant(m, 1)};
    for (const double bad : {std::nan(""), infinity, -infinity}) {
      Problem problem = good;
      problem.free[0] = bad;
      const Solution s = solve(problem);
      CHECK_FALSE(s.outcome.converged);
      CHECK(s.p == VectorXd::Zero(m));
    }
    Problem problem = good;
    problem.W(m - 1, 0) = std::nan("");
    const Solution s = solve(problem);
    CHECK_FALSE(s.outcome.converged);
    CHECK(std::isfinite(s.p.sum()));
  }
}

TEST_CASE("the start changes the efforts by round-off only", "[box]") {
  Random random(14);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Problem problem = random.problem(30, 2);
    const Solution cold = solve(problem);
    const Solution warm = solve(problem, cold.p);
    CHECK(warm.outcome.iterations <= cold.outcome.iterations);
    CHECK(warm.outcome.iterations == 1);
    CHECK(warm.p == cold.p);
    const Solution astray = solve(problem, VectorXd::NullaryExpr(30, [&] { return random(-1, 1); }));
    check_complementarity(problem, astray);
    // Condition 100.
    CHECK((astray.p - cold.p).norm() <= 1e5 * epsilon * (1 + cold.p.norm()));
  }
}

TEST_CASE("a lane among others gives what it gives alone, bit for bit", "[box]") {
  Random random(15);
  constexpr int m = 25, lanes = 7;
  const MatrixXd W = random.spd(m, 3);
  using Block = Eigen::Matrix<double, m, lanes, Eigen::RowMajor>;
  Block free, lower, upper, p = Block::Zero();
  std::vector<Problem> alone;
  for (int lane = 0; lane < lanes; ++lane) {
    Problem problem = random.problem(m, 1);
    problem.W = W;
    free.col(lane) = problem.free;
    lower.col(lane) = problem.lower;
    upper.col(lane) = problem.upper;
    alone.push_back(problem);
  }
  BoxSolver solver;
  solver.prepare(m + 5);
  Columns columns(W);
  for (int lane = lanes - 1; lane >= 0; --lane) {
    solver.solve(columns, 1, 0, free.data() + lane, lower.data() + lane, upper.data() + lane, p.data() + lane, m,
                 lanes);
    CHECK(VectorXd(p.col(lane)) == solve(alone[static_cast<std::size_t>(lane)]).p);
  }
}

TEST_CASE("solve allocates nothing, not even in descent", "[box]") {
  const long before_prepare = allocations();
  BoxSolver solver;
  solver.prepare(50);
  REQUIRE(allocations() > before_prepare);
  Random random(16);
  for (int repeat = 0; repeat < 30; ++repeat) {
    Problem problem = random.problem(50, repeat % 10);
    if (repeat % 5 == 0) problem.W.col(3) = problem.W.col(4), problem.W.row(3) = problem.W.row(4);
    Columns columns(problem.W);
    VectorXd p = VectorXd::Zero(50);
    const long before = allocations();
    solver.solve(columns, 1, 0, problem.free.data(), problem.lower.data(), problem.upper.data(), p.data(), 50);
    CHECK(allocations() == before);
  }
}
