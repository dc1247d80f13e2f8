#include <ricochet/scene/assembly.hpp>

#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

FiniteElementSpace bar(BarSpec::Fixed fixed, int elements) {
  return make_space(BarSpec{.length = 3, .EA = 1, .rhoA = 2, .fixed = fixed, .damping = {}}, elements);
}

}  // namespace

TEST_CASE("redistributed: the free end has no mass; total mass and centre of gravity are the lumped ones") {
  for (const auto fixed : {BarSpec::Fixed::right, BarSpec::Fixed::left, BarSpec::Fixed::none}) {
    const FiniteElementSpace space = bar(fixed, 7);
    const Inertia moved = built(*mass("redistributed"), space), lumped = built(*mass("lumped"), space);
    const Eigen::MatrixXd M = dense_mass(moved), L = dense_mass(lumped);
    CHECK(moved.kernel_dimension == (fixed == BarSpec::Fixed::none ? 2 : 1));
    CHECK(M.diagonal().minCoeff() == 0);
    Eigen::VectorXd one = Eigen::VectorXd::Ones(space.dofs), x(space.dofs);
    const auto places = dof_places(space);
    for (int i = 0; i < space.dofs; ++i) x[i] = places[static_cast<std::size_t>(i)].x;
    // Sums of a few numbers of size one.
    CHECK(one.dot(M * one) == Approx(one.dot(L * one)).epsilon(1e-14));
    CHECK(one.dot(M * x) == Approx(one.dot(L * x)).epsilon(1e-13));
    if (fixed != BarSpec::Fixed::left) CHECK(M(0, 0) == 0);
    if (fixed != BarSpec::Fixed::right) CHECK(M(space.dofs - 1, space.dofs - 1) == 0);
  }
}

TEST_CASE("redistributed: refuses beams, oscillators and meshes without room") {
  const auto refused = [](const FiniteElementSpace& space) {
    auto made = mass("redistributed")->build(space);
    return std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence : std::string("built");
  };
  CHECK(refused(make_space(unit_beam().structure, 4)).find("use the mass singular") != std::string::npos);
  CHECK(refused(make_space(OscillatorSpec{}, 1)).find("oscillator") != std::string::npos);
  CHECK(refused(bar(BarSpec::Fixed::right, 2)).find("at least 3 elements") != std::string::npos);
  CHECK(refused(bar(BarSpec::Fixed::right, 3)) == "built");
  CHECK(refused(bar(BarSpec::Fixed::none, 4)).find("at least 5 elements") != std::string::npos);
}
