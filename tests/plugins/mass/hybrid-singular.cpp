#include "tests/eigen.hpp"
#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

FiniteElementSpace bar(BarSpec::Fixed fixed, int elements, std::vector<int> contact) {
  auto space = make_space(BarSpec{.length = 3, .EA = 1, .rhoA = 2, .fixed = fixed, .damping = {}}, elements);
  space.contact_dofs = std::move(contact);
  return space;
}

std::string refusal(const FiniteElementSpace& space) {
  auto made = mass("hybrid-singular")->build(space);
  return std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence.text : std::string("built");
}

}  // namespace

TEST_CASE("hybrid-singular: without stops a bar has its consistent mass") {
  for (const auto fixed : {BarSpec::Fixed::right, BarSpec::Fixed::left, BarSpec::Fixed::none}) {
    const auto space = bar(fixed, 5, {});
    const Inertia inertia = built(*mass("hybrid-singular"), space);
    const Eigen::MatrixXd gap = dense_mass(inertia) - dense_mass(built(*mass("consistent"), space));
    CHECK(gap.cwiseAbs().maxCoeff() <= 1e-15);
    CHECK(inertia.kernel_dimension == 0);
  }
}

TEST_CASE("hybrid-singular: a bar node that may touch a stop carries nothing, its neighbours its mass") {
  const auto space = bar(BarSpec::Fixed::none, 8, {0, 4});
  const Inertia inertia = built(*mass("hybrid-singular"), space);
  const Eigen::MatrixXd M = dense_mass(inertia);
  CHECK(inertia.kernel_dimension == 2);
  for (const int dof : space.contact_dofs) CHECK(M.row(dof).norm() == 0);
  CHECK(rigid_mass(inertia, space)(0, 0) == Approx(6).epsilon(1e-14));
  const double m = 0.75;  // of an element
  CHECK(M(1, 1) == Approx(m + m / 3).epsilon(1e-14));
  CHECK(M(1, 2) == Approx(m / 6).epsilon(1e-14));
  CHECK(M(3, 3) == Approx(m + m / 3).epsilon(1e-14));
  CHECK(M(3, 5) == 0);
}

TEST_CASE("hybrid-singular: a beam has one kernel dimension per element, whatever touches it") {
  for (int elements : {1, 2, 17, 60}) check_inertia(*mass("hybrid-singular"), elements, elements);
  SceneSpec scene = working_set();
  scene.stops.place = StopsSpec::Place::nodes;
  const SemiDiscrete p = discretised(scene, 12, *mass("hybrid-singular"));
  // Its kernel moves every contact point on its own: no impact moves mass.
  const Eigen::MatrixXd moved = p.contact * mass_kernel(p.inertia);
  CHECK(eigen::rank(moved) == 12);
  // Duals reproduce velocities that are linear between nodes; a translation of the free nodes is one from node 1 on.
  CHECK(rigid_mass(p.inertia, p.space)(0, 0) ==
        Approx(rigid_mass(built(*mass("consistent"), p.space), p.space)(0, 0)).epsilon(0.01));
}

TEST_CASE("hybrid-singular: first pulsations, order 2 on bars and 4 on beams") {
  const auto strategy = mass("hybrid-singular");
  CHECK(pulsation_error(*strategy, unit_bar(true), 16) == Approx(5.518e-4).margin(1e-6));
  // Between 8 and 16 elements 2.34, 2.12 between 32 and 64: one element of the wrong velocity, over a mesh of order 2.
  CHECK(pulsation_order(*strategy, unit_bar(true), 16) == Approx(2.21).margin(0.01));
  CHECK(pulsation_order(*strategy, unit_bar(false), 16) == Approx(2).margin(0.01));
  CHECK(pulsation_error(*strategy, unit_beam(), 16) == Approx(2.137e-6).margin(2e-9));
  CHECK(pulsation_order(*strategy, unit_beam(), 16) == Approx(3.93).margin(0.02));
}

TEST_CASE("hybrid-singular: a point mass keeps its inertia, at a stop too") {
  auto space = bar(BarSpec::Fixed::right, 6, {0});
  const Eigen::MatrixXd bare = dense_mass(built(*mass("hybrid-singular"), space));
  space.point_masses = {{0, 0.7}, {2, 0.3}};
  const Inertia loaded = built(*mass("hybrid-singular"), space);
  Eigen::MatrixXd difference = dense_mass(loaded) - bare;
  difference(0, 0) -= 0.7;
  difference(2, 2) -= 0.3;
  CHECK(difference.cwiseAbs().maxCoeff() <= 1e-15);
  CHECK(loaded.kernel_dimension == 0);
}

TEST_CASE("hybrid-singular: where no velocity is left it says what to use") {
  CHECK(refusal(bar(BarSpec::Fixed::right, 6, {2, 3})).find("leave a free node between them") != std::string::npos);
  CHECK(refusal(bar(BarSpec::Fixed::right, 1, {0})).find("leave a free node between them") != std::string::npos);
  CHECK(refusal(oscillator_space(1)).find("use the mass consistent or lumped") != std::string::npos);
  CHECK(refusal(bar(BarSpec::Fixed::right, 6, {2, 4})) == "built");
}
