// Points within circles: what a scalar law pushes with, along which radius.
#include <catch2/catch.hpp>
#include <random>
#include <ricochet/contact_solvers/circle_solver.hpp>

#include "tests/contact_solvers/pointwise_problems.hpp"

using namespace pointwise_solver_tests;

namespace {

/// k δⁿ, or its discrete gradient.
class PowerContact final : public PointwiseContact {
 public:
  PowerContact(double k, double n, StepForce force)
      : PointwiseContact({force == StepForce::at_measure ? Evaluation::implicit_end : Evaluation::conserving, force}),
        k_(k),
        n_(n) {}

  double push(double depth) const { return depth > 0 ? k_ * std::pow(depth, n_) : 0; }
  double stored(double depth, int) const override { return depth > 0 ? push(depth) * depth / (n_ + 1) : 0; }

 private:
  void set_lanes(std::span<const Parameters>) override {}
  PointForce at(const ContactState& s) const override {
    return {push(s.depth), s.depth > 0 ? n_ * push(s.depth) / s.depth : 0, 0, 0, 0};
  }
  PointForce gradient(const ContactState& s) const override {
    const double change = s.depth - s.before;
    if (std::abs(change) < 1e-9 * std::abs(s.depth)) return at({.depth = 0.5 * (s.depth + s.before)});
    const double mean = (stored(s.depth, 0) - stored(s.before, 0)) / change;
    return {mean, (push(s.depth) - mean) / change, 0, (mean - push(s.before)) / change, 0};
  }
  double k_, n_;
};

/// Circles, then points between ordinary bounds.
struct Scene {
  MatrixXd W;
  VectorXd free, before, lower, upper;
  std::vector<int> circles;
  int points() const { return static_cast<int>(free.size()); }
  StopCircle circle(int first) const { return StopCircle::of(lower, upper, first); }
};

Scene random_scene(std::mt19937& random, int circles, int others, double mobility, double start) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> radius(0.5, 1.5);
  const int m = 2 * circles + others;
  Scene scene;
  MatrixXd A(m, m);
  for (double& entry : A.reshaped()) entry = normal(random);
  scene.W = mobility * (A * A.transpose()) / m + 0.1 * mobility * MatrixXd::Identity(m, m);
  scene.free.resize(m);
  scene.before.resize(m);
  scene.lower.resize(m);
  scene.upper.resize(m);
  for (int i = 0; i < m; ++i) {
    scene.free[i] = start * normal(random);
    scene.before[i] = start * normal(random);
    scene.lower[i] = -1;
    scene.upper[i] = 1;
  }
  for (int c = 0; c < circles; ++c) {
    const double r = radius(random);
    for (const int i : {2 * c, 2 * c + 1}) {
      const double centre = 0.3 * normal(random);
      scene.lower[i] = centre - r;
      scene.upper[i] = centre + r;
    }
    scene.circles.push_back(2 * c);
  }
  return scene;
}

struct Found {
  VectorXd p, u;
  LaneOutcome outcome;
};

Found solved(const Scene& scene, PowerContact& law, double reach, VectorXd start = {}) {
  const int m = scene.points();
  law.prepare(m, std::vector<Parameters>(1));
  CircleSolver solver;
  solver.prepare(m, 1, scene.circles, 0);
  Columns columns(scene.W);
  Found found;
  found.p = start.size() > 0 ? start : VectorXd(VectorXd::Zero(m));
  const std::vector<int> touched{0};
  ReducedProblem reduced;
  reduced.points = m;
  reduced.lanes = 1;
  reduced.delassus = &columns;
  reduced.reach = reach;
  reduced.free = scene.free.data();
  reduced.lower = scene.lower.data();
  reduced.upper = scene.upper.data();
  if (law.reads() == Evaluation::conserving) reduced.before = scene.before.data();
  reduced.effort = found.p.data();
  reduced.touched = touched;
  reduced.outcome = &found.outcome;
  solver.solve(law, reduced);
  found.u = scene.free + reach * scene.W * found.p;
  return found;
}

}  // namespace

TEST_CASE("a point within a circle is pushed along its radius, by what the law says of the radial depth") {
  std::mt19937 random(3);
  for (const double exponent : {1.0, 1.5, 3.0})
    for (const double mobility : {1e-6, 1e-2, 1.0, 1e2, 1e6})
      for (int k = 0; k < 60; ++k) {
        INFO(exponent << " " << mobility << " " << k);
        const Scene scene = random_scene(random, 1 + k % 4, k % 3, mobility, 3);
        PowerContact law(1, exponent, StepForce::at_measure);
        const Found found = solved(scene, law, 1);
        REQUIRE(found.outcome.converged);
        // u° + ηWp loses this much of the efforts.
        const double lost = 1e-12 * (1 + scene.free.cwiseAbs().maxCoeff());
        for (const int first : scene.circles) {
          const StopCircle circle = scene.circle(first);
          const Eigen::Vector2d from = found.u.segment<2>(first) - Eigen::Vector2d(circle.centre[0], circle.centre[1]);
          const double N = law.push(from.norm() - circle.radius), depth = from.norm() - circle.radius;
          // The same as a depth: forces of stiff springs are known as well as their depths.
          const double slope = depth > 0 ? exponent * N / depth : 0;
          CHECK((found.p.segment<2>(first) + N * from.normalized()).norm() <= lost * (slope + 1));
        }
        for (int i = 2 * static_cast<int>(scene.circles.size()); i < scene.points(); ++i) {
          const double over = law.push(found.u[i] - 1), under = law.push(-1 - found.u[i]);
          CHECK(std::abs(found.p[i] - (under - over)) <=
                lost * (1 + exponent * std::pow(3.0 + std::abs(found.u[i]), exponent)));
        }
      }
}

TEST_CASE("a discrete gradient in a circle gives the work of its energy, whatever the step") {
  std::mt19937 random(5);
  for (const double mobility : {1e-6, 1e-3, 1e-1})
    for (int k = 0; k < 100; ++k) {
      INFO(mobility << " " << k);
      const Scene scene = random_scene(random, 2, 0, mobility, 2);
      PowerContact law(1, 1.5, StepForce::gradient);
      const Found found = solved(scene, law, 1);
      REQUIRE(found.outcome.converged);
      for (const int first : scene.circles) {
        const StopCircle circle = scene.circle(first);
        const auto stored = [&](const VectorXd& u) {
          return law.stored(circle.distance(u[first], u[first + 1]) - circle.radius, 0);
        };
        const double work = -found.p.segment<2>(first).dot((found.u - scene.before).segment<2>(first));
        CHECK(work == Approx(stored(found.u) - stored(scene.before)).margin(1e-11));
      }
    }
}

TEST_CASE("the same efforts from any first guess, and turned with the scene") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 50; ++k) {
    Scene scene = random_scene(random, 2, 0, 1, 3);
    PowerContact law(1, 1.5, StepForce::at_measure);
    const Found found = solved(scene, law, 1);
    const Found again = solved(scene, law, 1, VectorXd::NullaryExpr(4, [&] { return normal(random); }));
    CHECK((found.p - again.p).norm() <= 1e-11 * (1 + found.p.norm()));
    const double angle = normal(random);
    MatrixXd R = MatrixXd::Identity(4, 4);
    R.topLeftCorner(2, 2) = R.bottomRightCorner(2, 2) =
        Eigen::Matrix2d{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
    Scene turned = scene;
    turned.W = R * scene.W * R.transpose();
    turned.free = R * scene.free;
    const VectorXd half = 0.5 * (scene.upper - scene.lower), centre = R * (0.5 * (scene.upper + scene.lower));
    turned.lower = centre - half;
    turned.upper = centre + half;
    CHECK((solved(turned, law, 1).p - R * found.p).norm() <= 1e-11 * (1 + found.p.norm()));
  }
}

TEST_CASE("a measure that no effort moves is looked at once") {
  std::mt19937 random(9);
  const Scene scene = random_scene(random, 1, 1, 1, 3);
  PowerContact law(2, 1.5, StepForce::at_measure);
  const Found found = solved(scene, law, 0);
  const StopCircle circle = scene.circle(0);
  const double rho = circle.distance(scene.free[0], scene.free[1]);
  REQUIRE(rho > circle.radius);
  for (const int axis : {0, 1})
    CHECK(found.p[axis] == Approx(-law.push(rho - circle.radius) *
                                  (scene.free[axis] - circle.centre[static_cast<std::size_t>(axis)]) / rho)
                               .epsilon(1e-14));
}
