#include <Eigen/QR>

#include "tests/eigen.hpp"
#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {
std::unique_ptr<MassStrategy> singular(const std::string& velocity) {
  return mass("singular", {{"velocity", velocity}});
}
}  // namespace

TEST_CASE("singular: symmetric, positive semidefinite, one kernel dimension per element") {
  for (int elements : {1, 2, 17, 60}) {
    check_inertia(*singular("P1"), elements, elements);
    check_inertia(*singular("P0"), elements, elements);
  }
}

TEST_CASE("singular: P1 comes in factors, banded node by node, P0 assembled, as sparse as K") {
  const auto space = make_space(working_set().structure, 9);
  const auto p1 = built(*singular("P1"), space), p0 = built(*singular("P0"), space);
  REQUIRE(p1.factored());
  CHECK(p1.coupling.rows() == 9);
  CHECK(p1.mass.size() == 0);
  for (int j = 0; j < p1.coupling.outerSize(); ++j)  // velocity i sees the dofs of nodes i−1, i, i+1
    for (SparseMatrix::InnerIterator it(p1.coupling, j); it; ++it) CHECK(std::abs(it.col() / 2 - it.row()) <= 1);
  REQUIRE_FALSE(p0.factored());
  for (int j = 0; j < p0.mass.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(p0.mass, j); it; ++it) CHECK(std::abs(it.row() - it.col()) <= 3);
}

TEST_CASE("singular: M is the projection of velocities, never more than the consistent mass") {
  const auto space = make_space(working_set().structure, 7);
  const Eigen::MatrixXd consistent = built(*mass("consistent"), space).mass;
  for (const char* velocity : {"P1", "P0"}) {
    const Eigen::MatrixXd gap = consistent - dense_mass(built(*singular(velocity), space));
    const double smallest = eigen::values(gap).minCoeff();
    CHECK(smallest >= -1e-14 * consistent.norm());  // round-off of the eigenvalues
  }
}

TEST_CASE("singular: P0 takes the mean velocity of each element") {
  const auto space = make_space(unit_beam().structure, 4);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(8);
  for (int node = 0; node < 4; ++node) v[2 * node] = 1;
  // Means of this motion: ½ on the first element, 1 on the three others, each of mass ¼.
  CHECK(v.dot(dense_mass(built(*singular("P0"), space)) * v) == Approx(0.25 * (0.25 + 3)).epsilon(1e-14));
}

TEST_CASE("singular: B and C_v are exact integrals, and a motion that projects onto v = x has its kinetic energy") {
  const auto space = make_space(unit_beam().structure, 4);
  const auto inertia = built(*singular("P1"), space);
  Eigen::VectorXd linear(4), square(8);
  for (int node = 1; node <= 4; ++node) {
    const double x = 0.25 * node;
    linear[node - 1] = x;
    square[2 * node - 2] = x * x;
    square[2 * node - 1] = 2 * x;
  }
  CHECK(linear.dot(inertia.velocity_mass * linear) == Approx(1.0 / 3).epsilon(1e-14));  // ∫x²
  CHECK(linear.dot(inertia.coupling * square) == Approx(1.0 / 4).epsilon(1e-14));       // ∫x·x²
  // B q' = C_v ν says that ν is the L² projection of q'; then q'ᵀM q' = ∫ρS ν².
  const Eigen::MatrixXd B = inertia.coupling;
  const Eigen::VectorXd motion = B.completeOrthogonalDecomposition().solve(inertia.velocity_mass * linear);
  CHECK(motion.dot(apply_mass(inertia, motion)) == Approx(1.0 / 3).epsilon(1e-12));
}

TEST_CASE("singular: first pulsation of 20 elements, orders 4 (P1) and 2 (P0)") {
  CHECK(first_pulsation(*singular("P1"), 20) == Approx(3.51601573).margin(6e-9));  // the digits printed
  CHECK(first_pulsation(*singular("P0"), 20) == Approx(3.51771846).margin(6e-9));
  // P1: velocities that vanish at the clamp add a term O(ℓ) relative, +0.2 over 5 to 20 elements, +0.13 here.
  CHECK(pulsation_order(*singular("P1")) == Approx(4).margin(0.15));
  CHECK(pulsation_order(*singular("P0")) == Approx(2).margin(0.05));
}

TEST_CASE("singular: the finite spectrum of P0 ends at 232.9969 EI/(ρSℓ⁴)") {
  CHECK(largest_eigenvalue(*singular("P0"), 40) == Approx(232.9969).margin(6e-5));
}

TEST_CASE("singular: a point mass keeps its inertia, in both forms") {
  auto space = make_space(unit_beam().structure, 3);
  for (const char* velocity : {"P1", "P0"}) {
    space.point_masses.clear();
    const auto bare = built(*singular(velocity), space);
    space.point_masses = {{4, 0.7}};
    const auto loaded = built(*singular(velocity), space);
    Eigen::MatrixXd difference = dense_mass(loaded) - dense_mass(bare);
    difference(4, 4) -= 0.7;
    CHECK(difference.cwiseAbs().maxCoeff() <= 1e-14);
    CHECK(loaded.kernel_dimension == bare.kernel_dimension - 1);
    CHECK(mass_kernel(loaded).cols() == 2);
  }
}

TEST_CASE("singular: where it does not apply it says what to use") {
  const auto sentence = [](const MassStrategy& strategy, const FiniteElementSpace& space) {
    const auto result = strategy.build(space);
    REQUIRE(std::holds_alternative<Refusal>(result));
    return std::get<Refusal>(result).sentence.text;
  };
  CHECK_THAT(sentence(*singular("P0"), oscillator_space(1)), Contains("oscillator") && Contains("use the mass"));
  CHECK_THAT(sentence(*singular("P1"), bar_space(4)), Contains("bar") && Contains("use velocity P0"));
}

TEST_CASE("singular: P0 on a bar averages the two ends of each element") {
  const Eigen::MatrixXd M = dense_mass(built(*singular("P0"), bar_space(3)));
  Eigen::Matrix3d expected;
  expected << 1, 1, 0, 1, 2, 1, 0, 1, 2;
  CHECK((M - expected / 12).cwiseAbs().maxCoeff() <= 1e-16);
}
