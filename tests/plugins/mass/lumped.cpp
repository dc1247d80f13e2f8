#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {
std::unique_ptr<MassStrategy> without_rotations() {
  return mass("lumped", {{"rotation", std::string("none")}});
}
}  // namespace

TEST_CASE("lumped: symmetric, positive, without rotations semidefinite, their number in the kernel") {
  for (int elements : {1, 2, 17}) {
    check_inertia(*mass("lumped"), elements, 0);
    check_inertia(*without_rotations(), elements, elements);
  }
}

TEST_CASE("lumped: diagonal, the consistent diagonal scaled to the mass of the beam") {
  const auto space = make_space(working_set().structure, 6);
  const SparseMatrix M = built(*mass("lumped"), space).mass;
  CHECK(M.nonZeros() == 12);
  const double element_mass = space.elements[0].line_density * space.elements[0].length;
  double total = element_mass / 2;  // of the clamped node
  for (int i = 0; i < 12; i += 2) total += M.coeff(i, i);
  CHECK(total == Approx(space.elements[0].line_density * 1.501).epsilon(1e-14));
  const SparseMatrix consistent = built(*mass("consistent"), space).mass;
  // One factor for the four functions of an element: m/(2·156m/420).
  for (int i = 0; i < 12; ++i) CHECK(M.coeff(i, i) / consistent.coeff(i, i) == Approx(420.0 / 312).epsilon(1e-14));
  const SparseMatrix bare = built(*without_rotations(), space).mass;
  CHECK(bare.nonZeros() == 6);
  for (int i = 0; i < 12; ++i) CHECK(bare.coeff(i, i) == (i % 2 == 0 ? M.coeff(i, i) : 0));
}

TEST_CASE("lumped: pulsations converge with order 2") {
  // Over 10 to 40 elements the next term, O(ℓ²) relative, bends the line by a few per cent.
  CHECK(pulsation_order(*mass("lumped")) == Approx(2).margin(0.1));
  CHECK(pulsation_order(*without_rotations()) == Approx(2).margin(0.1));
}

TEST_CASE("lumped: linear elements give row sums of the consistent matrix") {
  const SparseMatrix M = built(*mass("lumped"), bar_space(3)).mass;
  CHECK(M.coeff(0, 0) == Approx(1.0 / 6).epsilon(1e-15));
  CHECK(M.coeff(1, 1) == Approx(1.0 / 3).epsilon(1e-15));
  CHECK(M.nonZeros() == 3);
}

TEST_CASE("lumped: point masses are added, on an oscillator they are all there is") {
  auto space = make_space(unit_beam().structure, 2);
  space.point_masses = {{3, 0.5}};
  const auto inertia = built(*without_rotations(), space);
  CHECK(inertia.mass.coeff(3, 3) == 0.5);
  CHECK(inertia.kernel_dimension == 1);
  CHECK(built(*mass("lumped"), oscillator_space(2)).mass.coeff(0, 0) == 2);
}
