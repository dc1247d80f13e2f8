#include <ricochet/scene/assembly.hpp>

#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

TEST_CASE("consistent: symmetric, positive definite") {
  for (int elements : {1, 2, 17}) check_inertia(*mass("consistent"), elements, 0);
}

TEST_CASE("consistent: the textbook element, ρSℓ/420 [156, 22ℓ, 54, −13ℓ, …]") {
  const auto space = make_space(unit_beam().structure, 1);
  const Eigen::MatrixXd M = built(*mass("consistent"), space).mass;
  Eigen::Matrix2d expected;
  expected << 156, -22, -22, 4;
  CHECK((M - expected / 420).cwiseAbs().maxCoeff() <= 1e-15);
}

TEST_CASE("consistent: exact kinetic energy of motions in the space, exact total mass") {
  // Velocity x²: ∫ρS x⁴ = 1/5, whatever the mesh.
  const auto space = make_space(unit_beam().structure, 3);
  const Eigen::MatrixXd M = built(*mass("consistent"), space).mass;
  Eigen::VectorXd square(6), rigid(6);
  square << 1.0 / 9, 2.0 / 3, 4.0 / 9, 4.0 / 3, 1, 2;
  rigid << 1, 0, 1, 0, 1, 0;
  CHECK(square.dot(M * square) == Approx(0.2).epsilon(1e-14));
  // Translation of the free nodes and, row by row, of the clamped one: the load of a rigid motion is M·1 plus its
  // column.
  const auto& e = space.elements[0];
  const Eigen::VectorXd s = rigid_motion_load(space);
  Eigen::VectorXd clamped = Eigen::VectorXd::Zero(6);
  clamped[0] = 54 * e.length / 420;
  clamped[1] = -13 * e.length * e.length / 420;
  CHECK((M * rigid + clamped - s).norm() <= 1e-15);
  // 1ᵀM1 over all nodes = ρSL: free part + twice the coupling to the clamped node + that node's own 156/420.
  CHECK(rigid.dot(M * rigid) + 2 * clamped.dot(rigid) + 156 * e.length / 420 == Approx(1).epsilon(1e-14));
}

TEST_CASE("consistent: first pulsation of 20 elements, order 4") {
  CHECK(first_pulsation(*mass("consistent"), 20) == Approx(3.51601546).margin(6e-9));  // the digits printed
  // Next term of the expansion, O(ℓ²) relative, over 10 to 40 elements.
  CHECK(pulsation_order(*mass("consistent")) == Approx(4).margin(0.05));
}

TEST_CASE("consistent: largest eigenvalue 3585.33837403 EI/(ρSℓ⁴) on a long mesh") {
  CHECK(largest_eigenvalue(*mass("consistent"), 40) == Approx(3585.33837403).epsilon(1e-9));
}

TEST_CASE("consistent: point masses are added, and dofs without inertia are counted") {
  auto space = make_space(unit_beam().structure, 2);
  const Eigen::MatrixXd bare = built(*mass("consistent"), space).mass;
  space.point_masses = {{2, 0.7}};
  const Eigen::MatrixXd loaded = built(*mass("consistent"), space).mass;
  CHECK(loaded(2, 2) == Approx(bare(2, 2) + 0.7).epsilon(1e-15));
  CHECK((loaded - bare).norm() == Approx(0.7).epsilon(1e-14));

  const auto oscillator = built(*mass("consistent"), oscillator_space(3));
  CHECK(oscillator.mass.coeff(0, 0) == 3);
  CHECK(oscillator.kernel_dimension == 0);
  CHECK(built(*mass("consistent"), oscillator_space(0)).kernel_dimension == 1);
}

TEST_CASE("consistent: linear elements, ℓ/6 [2 1, 1 2]") {
  const Eigen::MatrixXd M = built(*mass("consistent"), bar_space(3)).mass;
  Eigen::Matrix3d expected;
  expected << 2, 1, 0, 1, 4, 1, 0, 1, 4;
  CHECK((M - expected / 18).cwiseAbs().maxCoeff() <= 1e-16);
}
