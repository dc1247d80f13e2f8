// Beams on any supports: mesh, matrices, frequencies, static modes.
#include <ricochet/scene/assembly.hpp>

#include "tests/scene/beam_numbers.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

constexpr double pi = std::numbers::pi;

// Circle d = 10 mm, 2 m, steel, pinned at both ends.
SceneSpec taut_wire(double tension) {
  SceneSpec scene = held_beam(2, {pinned("left", 0), pinned("right", 2)});
  BeamSpec& beam = beam_of(scene);
  beam.young = 2e11;
  beam.density = 7800;
  beam.section = {.type = Section::Type::circle, .diameter = 0.01};
  beam.tension = tension;
  return scene;
}

}  // namespace

TEST_CASE("a clamp that is given equals the clamp that is not, bit for bit") {
  SceneSpec plain = working_set(), given = working_set();
  plain.stops.place = given.stops.place = StopsSpec::Place::nodes;
  beam_of(given).supports = {clamped("wall", 0)};
  // One section that is written as a list is one section.
  beam_of(given).sections = {{1.501, beam_of(given).section, 2e11, 8000}};
  for (const int elements : {1, 7, 30}) {
    const SemiDiscrete a = discretised(plain, elements, *mass("consistent"));
    const SemiDiscrete b = discretised(given, elements, *mass("consistent"));
    CHECK(a.space.left_fixed == b.space.left_fixed);
    REQUIRE(a.space.elements.size() == b.space.elements.size());
    for (std::size_t e = 0; e < a.space.elements.size(); ++e) {
      CHECK(a.space.elements[e].left == 1.501 * static_cast<double>(e) / elements);
      CHECK(a.space.elements[e].length == 1.501 / elements);
      CHECK(a.space.elements[e].left == b.space.elements[e].left);
      CHECK(a.space.elements[e].dof == b.space.elements[e].dof);
    }
    CHECK((a.stiffness - b.stiffness).norm() == 0);
    CHECK((a.inertia.mass - b.inertia.mass).norm() == 0);
    CHECK((a.contact - b.contact).norm() == 0);
    CHECK(a.contact_x == b.contact_x);
    CHECK(a.position == b.position);
    CHECK(a.support_shape == b.support_shape);
    CHECK((a.tip - b.tip).norm() == 0);
    CHECK((a.held && b.held));
    // The static mode of the only support, found by solving: the translation, to the condition of K times round-off.
    CHECK((a.static_modes - b.static_modes).norm() <= 1e-9 * a.static_modes.norm());
    CHECK((a.support_loads - b.support_loads).norm() <= 1e-9 * a.support_loads.norm());
  }
}

TEST_CASE("nodes stand at supports, ends of sections and masses, each interval has its share of elements") {
  const SceneSpec scene = held_beam(3, {pinned("a", 0), pinned("b", 1), pinned("c", 3)});
  BeamSpec beam = beam_of(scene);
  beam.masses = {{.x = 2.9, .mass = 1}};
  const auto intervals = beam_intervals(beam, 12);
  REQUIRE(intervals.size() == 3);
  CHECK(intervals[0].elements == 4);
  CHECK(intervals[1].elements == 8);  // 7.6
  CHECK(intervals[2].elements == 1);  // 0.4: an interval has an element
  const std::vector<double> nodes = beam_nodes(beam, 12);
  CHECK(nodes.size() == 14);
  CHECK(nodes[4] == 1);
  CHECK(nodes[12] == 2.9);
  CHECK(nodes.back() == 3);
  // Decimals that differ by round-off are one place.
  beam.sections = {{2.9 + 1e-12, beam.section, 0, 0}, {3, beam.section, 0, 0}};
  CHECK(beam_nodes(beam, 12).size() == nodes.size());
}

TEST_CASE("like sections are one section, bit for bit") {
  const SceneSpec whole = taut_wire(0);
  SceneSpec parts = whole;
  const BeamSpec& beam = beam_of(whole);
  // Halves: 2/20 and 1/10 are the same number.
  beam_of(parts).sections = {{1, beam.section, beam.young, beam.density}, {2, beam.section, beam.young, beam.density}};
  const SemiDiscrete a = discretised(whole, 20, *mass("consistent")), b = discretised(parts, 20, *mass("consistent"));
  CHECK((a.stiffness - b.stiffness).norm() == 0);
  CHECK((a.inertia.mass - b.inertia.mass).norm() == 0);
}

TEST_CASE("a pinned beam under tension: f_n = n/(2L) √(T/ρA + (nπ/L)² EI/ρA)") {
  for (const double tension : {0.0, 10.0, 100.0, 1000.0, -3.0}) {
    const SceneSpec scene = taut_wire(tension);
    const SectionProperties section = section_properties(beam_of(scene).section, 2e11, 7800);
    const auto exact = [&](int n) {
      const double k = n * pi / 2;
      return k * std::sqrt(tension / section.rhoS + k * k * section.EI / section.rhoS);
    };
    // The error of a mode is (kℓ)⁴/720 in ω² of cubic elements.
    const Eigen::VectorXd coarse = pulsations(scene, 20), fine = pulsations(scene, 160);
    CHECK(coarse[0] == Approx(exact(1)).epsilon(1e-6));
    CHECK(coarse[4] == Approx(exact(5)).epsilon(3e-4));
    CHECK(fine[4] == Approx(exact(5)).epsilon(1e-6));
  }
  // Published: code_aster, test SDLL101, in Hz.
  CHECK(pulsations(taut_wire(10), 20)[0] / (2 * pi) == Approx(5.07285).epsilon(2e-6));
  CHECK(pulsations(taut_wire(1000), 20)[0] / (2 * pi) == Approx(11.25771).epsilon(2e-6));
}

TEST_CASE("spans in a row: the roots of the three-moment equation") {
  const auto check = [](int spans, const std::vector<double>& roots) {
    const Eigen::VectorXd found = pulsations(held_beam(spans, pinned_at_each(spans)), 64 * spans);
    for (std::size_t i = 0; i < roots.size(); ++i)
      CHECK(std::sqrt(found[static_cast<Eigen::Index>(i)]) == Approx(roots[i]).epsilon(1e-6));
  };
  // sinh λ cos λ − cosh λ sin λ = cos(πj/N)(sin λ − sinh λ), j = 1 … N−1, and λ = π.
  check(2, {pi, 3.926602});
  check(3, {pi, 3.556409, 4.297530});
  check(5, {pi, 3.309052, 3.700360, 4.152944, 4.550434});
}

TEST_CASE("elastic supports: roots of the characteristic equation") {
  const auto check = [](const std::vector<BeamSupport>& supports, const std::vector<double>& roots) {
    const Eigen::VectorXd found = pulsations(held_beam(1, supports), 120);
    for (std::size_t i = 0; i < roots.size(); ++i)
      CHECK(std::sqrt(found[static_cast<Eigen::Index>(i)]) == Approx(roots[i]).epsilon(1e-7));
  };
  check({elastic("a", 0, 100), elastic("b", 1, 100)}, {2.8767507, 4.6637846, 6.0761711});
  check({clamped("a", 0), elastic("b", 1, 100)}, {3.6405417, 5.6159961, 8.0840869});
  check({clamped("a", 0), pinned("b", 1), elastic("c", 0.5, 500, 10)}, {5.8252977, 7.6165662, 10.4727866});
}

TEST_CASE("stiff springs hold as a support does, with an error of the order of their compliance") {
  const double rigid = pulsations(held_beam(2, {clamped("a", 0), pinned("b", 1.2)}), 40)[0];
  double before = 0;
  for (const double stiffness : {1e4, 1e5, 1e6}) {
    const double gap = rigid - pulsations(held_beam(2, {clamped("a", 0), elastic("b", 1.2, stiffness)}), 40)[0];
    CHECK(gap > 0);
    if (before > 0) CHECK(before / gap == Approx(10).epsilon(0.05));
    before = gap;
  }
  CHECK(before < 1e-4 * rigid);
}

TEST_CASE("a tube with a mass at its tip: SDLL15 of code_aster") {
  SceneSpec scene = unit_beam();
  scene.stops = {};
  BeamSpec& beam = beam_of(scene);
  beam.length = 10;
  beam.young = 2.1e11;
  beam.density = 7800;
  beam.section = {.type = Section::Type::tube, .outer_diameter = 0.35, .wall = 0.015};
  beam.masses = {{.x = 10, .mass = 1000}};
  const Eigen::VectorXd found = pulsations(scene, 20) / (2 * pi);
  const std::vector<double> hertz = {1.655433, 16.07116, 50.0240, 103.2044};
  for (std::size_t i = 0; i < hertz.size(); ++i)
    CHECK(found[static_cast<Eigen::Index>(i)] == Approx(hertz[i]).epsilon(1e-5));
}

TEST_CASE("a foundation adds k_f/ρS to every ω², a mass per length divides it") {
  SceneSpec scene = held_beam(1, {pinned("a", 0), pinned("b", 1)});
  const Eigen::ArrayXd bare = pulsations(scene, 10).array().square();
  beam_of(scene).foundation = 700;
  const Eigen::ArrayXd founded = pulsations(scene, 10).array().square();
  CHECK((founded - bare - 700).abs().maxCoeff() <= 1e-9 * founded.maxCoeff());
  beam_of(scene).added_mass = 3;
  CHECK((4 * pulsations(scene, 10).array().square() - founded).abs().maxCoeff() <= 1e-9 * founded.maxCoeff());
}

TEST_CASE("an inertia on a rotation: a free beam that a mass of inertia turns with") {
  // Pinned at 0, a spring c against rotation there; with a huge inertia J the first ω² is that of a rigid rotation.
  SceneSpec scene = held_beam(1, {pinned("a", 0), elastic("b", 1, 10)});
  beam_of(scene).masses = {{.x = 0, .mass = 5, .inertia = 1e6}};
  // The mass stands on a support and has no part; k L² = 10 N m turns J.
  CHECK(pulsations(scene, 10)[0] == Approx(std::sqrt(10.0 / (1 + 10.0 / 3) / 1e6)).epsilon(1e-5));
}

TEST_CASE("a point force on a pinned beam: w = F a² b²/(3 EI L)") {
  for (const double a : {0.5, 0.3}) {
    SceneSpec scene = held_beam(1, {pinned("left", 0), pinned("right", 1)});
    scene.load.terms = {{.force = true, .at = a, .shape = Formula(), .history = Formula(2.0)}};
    const SemiDiscrete problem = discretised(scene, 10, *mass("consistent"));
    Eigen::VectorXd F(problem.dofs());
    problem.load->assemble(0, F.data());
    const double w = (displacement_rows(problem.space, {a}) * eigen::ldlt_solve(problem.stiffness, F))(0);
    CHECK(w == Approx(2 * a * a * (1 - a) * (1 - a) / 3).epsilon(1e-11));
  }
}

TEST_CASE("static modes: straight lines, cubics, and a beam on four supports") {
  const auto mode_at = [](const SemiDiscrete& problem, double x, int j) {
    return (displacement_rows(problem.space, {x}) * problem.static_modes)(0, j);
  };
  const SemiDiscrete two = discretised(held_beam(2, {pinned("a", 0), pinned("b", 2)}), 8, *mass("consistent"));
  CHECK(two.supports == std::vector<std::string>{"a", "b"});
  CHECK(mode_at(two, 0.5, 0) == Approx(0.75).epsilon(1e-12));
  CHECK(mode_at(two, 0.5, 1) == Approx(0.25).epsilon(1e-12));
  const SemiDiscrete stiff = discretised(held_beam(1, {clamped("a", 0), clamped("b", 1)}), 8, *mass("consistent"));
  CHECK(mode_at(stiff, 0.25, 1) == Approx(0.25 * 0.25 * (3 - 0.5)).epsilon(1e-12));
  // Three moments: 4 M₁ + M₂ = 12 (one unit at the second support), M₁ + 4 M₂ = −6, hence M₁ = 18/5.
  const SemiDiscrete spans = discretised(held_beam(3, pinned_at_each(3)), 48, *mass("consistent"));
  CHECK(mode_at(spans, 0.5, 1) == Approx(0.725).epsilon(1e-10));
}

TEST_CASE("static modes sum to the translation, their loads to that of the translation, whatever the supports") {
  std::vector<std::vector<BeamSupport>> held = {
      {pinned("a", 0), pinned("b", 1), pinned("c", 2)},
      {clamped("a", 0.3), elastic("b", 1.7, 30, 4)},
      {elastic("a", 0, 100), elastic("b", 2, 3)},
      {sliding("a", 0), pinned("b", 2)},
      {pinned("a", 0)},  // turns
  };
  for (const auto& supports : held) {
    SceneSpec scene = held_beam(2, supports);
    beam_of(scene).tension = 5;
    beam_of(scene).masses = {{.x = 1.1, .mass = 0.4, .inertia = 0.1}};
    const SemiDiscrete problem = discretised(scene, 20, *mass("consistent"));
    const Eigen::VectorXd sum = problem.static_modes.rowwise().sum();
    const auto places = dof_places(problem.space);
    for (Eigen::Index i = 0; i < sum.size(); ++i)
      CHECK(sum[i] == Approx(places[static_cast<std::size_t>(i)].slope ? 0 : 1).margin(1e-8));
    CHECK((problem.support_loads.rowwise().sum() - problem.support_shape).norm() <=
          1e-9 * problem.support_shape.norm());
  }
  // Whose ground stays at rest holds the beam back.
  SceneSpec founded = held_beam(2, pinned_at_each(2));
  beam_of(founded).foundation = 1000;
  const SemiDiscrete problem = discretised(founded, 20, *mass("consistent"));
  const double middle = (displacement_rows(problem.space, {0.5}) * problem.static_modes.rowwise().sum())(0);
  CHECK((middle > 0 && middle < 0.9));
}

TEST_CASE("contact at all nodes leaves out what is held, the tip is a free end, or the middle of the longest span") {
  SceneSpec scene = held_beam(3, pinned_at_each(3));
  scene.stops = {Formula(-1.0), Formula(1.0), StopsSpec::Place::nodes, {}};
  CHECK(contact_positions(scene, 6) == std::vector<double>{0.5, 1.5, 2.5});
  CHECK(tip_position(scene) == 0.5);
  beam_of(scene).supports = {pinned("a", 0), pinned("b", 1)};
  CHECK(tip_position(scene) == 3);
  beam_of(scene).supports = {pinned("a", 1), pinned("b", 3)};
  CHECK(tip_position(scene) == 0);
  const SemiDiscrete problem = discretised(scene, 6, *mass("consistent"));
  CHECK(problem.points() == 5);
  CHECK(problem.dofs() == 12);
}

TEST_CASE("beams that move rigidly say so, and are not held") {
  const auto freedom = [](std::vector<BeamSupport> supports) {
    const SceneSpec scene = held_beam(1, std::move(supports));
    return rigid_freedom(beam_of(scene));
  };
  CHECK((freedom({}).translates && freedom({}).turns));
  CHECK((!freedom({pinned("a", 0.4)}).translates && freedom({pinned("a", 0.4)}).turns));
  CHECK((freedom({sliding("a", 0.4)}).translates && !freedom({sliding("a", 0.4)}).turns));
  CHECK(freedom({sliding("a", 0), pinned("b", 1)}).held());
  CHECK(freedom({elastic("a", 0, 1), elastic("b", 1, 1)}).held());
  CHECK(freedom({elastic("a", 0, 1, 1)}).held());
  CHECK_FALSE(discretised(held_beam(1, {}), 4, *mass("consistent")).held);
  // The free beam: ω of the clamped–clamped one, after two rigid motions.
  const SemiDiscrete free = discretised(held_beam(1, {}), 40, *mass("consistent"));
  const Eigen::VectorXd squares = eigen::modes(free.stiffness, dense_mass(free.inertia)).values;
  CHECK(std::abs(squares[1]) < 1e-4);
  CHECK(std::sqrt(squares[2]) == Approx(4.730040745 * 4.730040745).epsilon(1e-6));
}
