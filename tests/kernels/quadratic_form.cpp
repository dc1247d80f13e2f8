#include <ricochet/kernels/quadratic_form.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

std::vector<double> some_vector(int n, double phase) {
  std::vector<double> x;
  for (int i = 0; i < n; ++i) x.push_back(std::sin(1.3 * i + phase) + 0.2);
  return x;
}

double dense(const Eigen::MatrixXd& A, const std::vector<double>& x, const std::vector<double>& y) {
  const Eigen::Map<const Eigen::VectorXd> a(x.data(), A.rows()), b(y.data(), A.rows());
  return a.dot(A * b);
}

}  // namespace

TEST_CASE("a quadratic form equals its dense matrix, for stiffness and every mass") {
  const auto name = GENERATE(std::string("consistent"), std::string("lumped"), std::string("P1"), std::string("P0"),
                             std::string("reciprocal"));
  const bool singular = name[0] == 'P';
  const auto strategy = singular ? mass("singular", {{"velocity", name}}) : mass(name);
  const SemiDiscrete problem = discretised(working_set(), 7, *strategy);
  const auto x = some_vector(problem.dofs(), 0.1), y = some_vector(problem.dofs(), 0.7);
  const QuadraticForm M = QuadraticForm::of(problem.inertia), K(problem.stiffness);
  // Sums of some dozens of terms of one size.
  CHECK(M(x.data()) == Approx(dense(dense_mass(problem.inertia), x, x)).epsilon(1e-12));
  CHECK(M(x.data(), y.data()) == Approx(dense(dense_mass(problem.inertia), x, y)).epsilon(1e-12));
  CHECK(K(x.data()) == Approx(dense(problem.stiffness, x, x)).epsilon(1e-12));
  CHECK(K(x.data(), y.data()) == Approx(dense(problem.stiffness, x, y)).epsilon(1e-12));
  CHECK(K(x.data(), y.data()) == Approx(K(y.data(), x.data())).epsilon(1e-12));
}

TEST_CASE("the elastic energy of a smooth shape keeps its digits on a fine mesh") {
  // u = 0.04 x² has the constant curvature 0.08: E = ½ EI 0.08² L, interpolated exactly. Entries of K q are 10⁶ times
  // larger.
  const SceneSpec scene = working_set();
  const SemiDiscrete problem = discretised(scene, 200, *mass("consistent"));
  const auto& beam = std::get<BeamSpec>(scene.structure);
  const double EI = section_properties(beam.section, beam.young, beam.density).EI;
  const double exact = 0.5 * EI * 0.08 * 0.08 * beam.length;
  const QuadraticForm K(problem.stiffness);
  CHECK(0.5 * K(problem.position.data()) == Approx(exact).epsilon(1e-7));
  // Evaluation noise: a relative change of 1e-15 of one nodal value must not show beyond what it does to the energy.
  Eigen::VectorXd nudged = problem.position;
  nudged[100] *= 1 + 1e-15;
  CHECK(std::abs(K(nudged.data()) - K(problem.position.data())) <= 1e-9 * exact);
}
