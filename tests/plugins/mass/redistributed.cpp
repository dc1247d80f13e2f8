#include <Eigen/LU>

#include "tests/plugins/mass/laws.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

FiniteElementSpace bar(BarSpec::Fixed fixed, int elements) {
  return make_space(BarSpec{.length = 3, .EA = 1, .rhoA = 2, .fixed = fixed, .damping = {}}, elements);
}

std::unique_ptr<MassStrategy> projected(int reach = 2) {
  return mass("redistributed", {{"form", std::string("projected")}, {"reach", static_cast<long long>(reach)}});
}

std::string refusal_of(const MassStrategy& strategy, const FiniteElementSpace& space) {
  auto made = strategy.build(space);
  return std::holds_alternative<Refusal>(made) ? std::get<Refusal>(made).sentence.text : std::string("built");
}

FiniteElementSpace touched(FiniteElementSpace space, std::vector<int> contact) {
  space.contact_dofs = std::move(contact);
  return space;
}

// Unit beam with a stop at its tip.
SceneSpec stopped_beam() {
  SceneSpec scene = unit_beam();
  scene.stops.place = StopsSpec::Place::tip;
  return scene;
}

}  // namespace

TEST_CASE("redistributed: the free end has no mass, total mass and centre of gravity are the lumped ones") {
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
  const auto refused = [](const FiniteElementSpace& space) { return refusal_of(*mass("redistributed"), space); };
  CHECK(refused(make_space(unit_beam().structure, 4)).find("use its form projected or the mass singular") !=
        std::string::npos);
  CHECK(refused(make_space(OscillatorSpec{}, 1)).find("oscillator") != std::string::npos);
  CHECK(refused(bar(BarSpec::Fixed::right, 2)).find("at least 3 elements") != std::string::npos);
  CHECK(refused(bar(BarSpec::Fixed::right, 3)) == "built");
  CHECK(refused(bar(BarSpec::Fixed::none, 4)).find("at least 5 elements") != std::string::npos);
}

TEST_CASE("redistributed: the lumped form is of order 2.6 on a bar, its kernel is the free end") {
  CHECK(pulsation_order(*mass("redistributed"), unit_bar(), 16) == Approx(2.6).margin(0.02));
  CHECK(discretised(unit_bar(), 8, *mass("redistributed")).inertia.kernel_dimension == 1);
}

TEST_CASE("redistributed: projected, contact dofs have no row and the rigid motions their mass") {
  const FiniteElementSpace beam = make_space(unit_beam().structure, 8);
  const auto spaces = {touched(bar(BarSpec::Fixed::right, 7), {0}),
                       touched(bar(BarSpec::Fixed::left, 7), {6}),
                       touched(bar(BarSpec::Fixed::none, 9), {0, 9}),
                       touched(bar(BarSpec::Fixed::none, 20), {0, 10, 20}),
                       touched(bar(BarSpec::Fixed::right, 12), {5}),
                       touched(beam, {14}),
                       touched(beam, {6, 14}),
                       touched(beam, {14, 15})};
  for (const FiniteElementSpace& space : spaces)
    for (const int reach : {2, 3, 0}) {
      INFO(space.structure << " of " << space.elements.size() << " elements, reach " << reach);
      const Inertia moved = built(*projected(reach), space), consistent = built(*mass("consistent"), space);
      const Eigen::MatrixXd M = moved.mass, C = consistent.mass;
      for (const int dof : space.contact_dofs) CHECK(M.row(dof).norm() == 0);
      CHECK(moved.kernel_dimension == static_cast<int>(space.contact_dofs.size()));
      for (Eigen::Index i = 0; i < M.rows(); ++i)
        for (Eigen::Index j = 0; j < M.rows(); ++j)
          if (C(i, j) == 0) CHECK(M(i, j) == 0);
      CHECK((M - M.transpose()).norm() == 0);
      const Eigen::Matrix2d gap = rigid_mass(moved, space) - rigid_mass(consistent, space);
      CHECK(gap.norm() <= 1e-12 * rigid_mass(consistent, space).norm());
    }
}

TEST_CASE("redistributed: projected, no matrix of this kind is nearer to the consistent one") {
  // Along any direction that keeps the three moments, the weighted distance is stationary: (M_r − M, N) = 0.
  const FiniteElementSpace space = touched(make_space(unit_beam().structure, 6), {10});
  const Eigen::MatrixXd M = built(*projected(0), space).mass, C = built(*mass("consistent"), space).mass;
  const auto places = dof_places(space);
  Eigen::MatrixXd X(space.dofs, 2);
  for (int i = 0; i < space.dofs; ++i) X.row(i) << (places[i].slope ? 0.0 : 1.0), (places[i].slope ? 1.0 : places[i].x);
  // Entries of the upper triangle that may change; each as a vector of its three moments.
  std::vector<std::pair<int, int>> entries;
  for (int i = 0; i < space.dofs; ++i)
    for (int j = i; j < space.dofs; ++j)
      if (i != 10 && j != 10 && C(i, j) != 0) entries.emplace_back(i, j);
  Eigen::MatrixXd moments(3, entries.size());
  Eigen::VectorXd gradient(entries.size());
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto [i, j] = entries[k];
    const double twice = i == j ? 1 : 2;
    moments.col(k) << twice * X(i, 0) * X(j, 0), twice / 2 * (X(i, 0) * X(j, 1) + X(i, 1) * X(j, 0)),
        twice * X(i, 1) * X(j, 1);
    gradient[k] = twice * (M(i, j) - C(i, j)) / (C(i, i) * C(j, j));
  }
  const Eigen::MatrixXd directions = Eigen::FullPivLU<Eigen::MatrixXd>(moments).kernel();
  for (Eigen::Index k = 0; k < directions.cols(); ++k)
    CHECK(std::abs(gradient.dot(directions.col(k))) <= 1e-10 * gradient.norm() * directions.col(k).norm());
}

TEST_CASE("redistributed: projected, order 1 over the whole mesh, that of the consistent mass near contact") {
  CHECK(pulsation_order(*projected(0), unit_bar(true), 32) == Approx(1).margin(0.1));
  CHECK(pulsation_order(*projected(0), stopped_beam(), 32) == Approx(1).margin(0.1));
  // On a bar the moved mass takes off what the consistent one adds: below its error of 1.0e-4 at 32 elements.
  CHECK(std::abs(pulsation_error(*projected(2), unit_bar(true), 32)) < 3e-5);
  CHECK(pulsation_error(*projected(2), stopped_beam(), 16) == Approx(9.31e-6).margin(1e-8));
  CHECK(pulsation_order(*projected(2), stopped_beam(), 16) == Approx(4.9).margin(0.1));
}

TEST_CASE("redistributed: projected, without stops nothing moves, point masses stay") {
  const FiniteElementSpace space = make_space(unit_beam().structure, 5);
  CHECK(Eigen::MatrixXd(built(*projected(), space).mass) == Eigen::MatrixXd(built(*mass("consistent"), space).mass));
  auto loaded = touched(bar(BarSpec::Fixed::right, 6), {0});
  const Eigen::MatrixXd bare = built(*projected(), loaded).mass;
  loaded.point_masses = {{0, 0.7}};
  const Inertia inertia = built(*projected(), loaded);
  CHECK(inertia.kernel_dimension == 0);
  CHECK(inertia.mass.coeff(0, 0) == 0.7);
  CHECK((Eigen::MatrixXd(inertia.mass) - bare).norm() == Approx(0.7));
}

TEST_CASE("redistributed: projected, refuses what no neighbour can carry") {
  SceneSpec scene = unit_beam();
  scene.stops.place = StopsSpec::Place::nodes;
  const auto nodes = discretise(scene, 8, *projected());
  REQUIRE(std::holds_alternative<Refusal>(nodes));
  CHECK(std::get<Refusal>(nodes).sentence.text.find("the mass singular") != std::string::npos);
  CHECK(refusal_of(*projected(), touched(bar(BarSpec::Fixed::none, 3), {0, 1, 2, 3})).find("fewer stops") !=
        std::string::npos);
  CHECK(refusal_of(*projected(1), touched(bar(BarSpec::Fixed::right, 6), {0})).find("use more elements") !=
        std::string::npos);
  CHECK(refusal_of(*projected(), oscillator_space(1)).find("use the mass consistent or lumped") != std::string::npos);
}
