// Forces at points and separable loads: what they assemble to, and what they may not be.
#include <ricochet/contract/errors.hpp>
#include <ricochet/scene/assembly.hpp>

#include "tests/eigen.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;
using Catch::Matchers::Contains;

namespace {

LoadTerm force_at(double x, const std::string& history) {
  return {true, x, {}, Formula(history, "/force", "t")};
}
LoadTerm separable(const std::string& shape, const std::string& history) {
  return {false, std::nullopt, Formula(shape, "/shape", "x"), Formula(history, "/time", "t")};
}
LoadSpec of_terms(std::vector<LoadTerm> terms) {
  LoadSpec load;
  load.terms = std::move(terms);
  return load;
}
Eigen::VectorXd assembled(const LoadSpec& load, const FiniteElementSpace& space, double t) {
  Eigen::VectorXd out(space.dofs);
  DistributedLoad(load, space).assemble(t, out.data());
  return out;
}

}  // namespace

TEST_CASE("a force at a node pushes that dof alone, between nodes its work is the force times the displacement there") {
  const auto space = make_space(unit_beam().structure, 4);
  const Eigen::VectorXd at_node = assembled(of_terms({force_at(0.75, "-3")}), space, 0);
  for (int i = 0; i < space.dofs; ++i) CHECK(at_node[i] == (i == 4 ? -3 : 0));

  // u = x³ is in the space: dofs (x³, 3x²) at each node.
  Eigen::VectorXd cube(space.dofs);
  for (int node = 0; node < 4; ++node) {
    const double x = 0.25 * (node + 1);
    cube[2 * node] = x * x * x;
    cube[2 * node + 1] = 3 * x * x;
  }
  for (const double x : {0.1, 0.6, 0.99, 1.0})
    CHECK(assembled(of_terms({force_at(x, "2")}), space, 0).dot(cube) == Approx(2 * x * x * x).epsilon(1e-14));

  // The force that bends a cantilever: tip FL³/3EI.
  const Eigen::MatrixXd K = bending_stiffness(space, 1);
  const Eigen::VectorXd q = eigen::ldlt_solve(K, assembled(of_terms({force_at(1, "6")}), space, 0));
  CHECK(q[6] == Approx(2).epsilon(1e-11));
}

TEST_CASE("a force at a point is the limit of a load on a short piece around it") {
  const auto space = make_space(unit_beam().structure, 3);
  const double x = 0.5;
  // Between nodes shape functions are cubics: ∫φ over a width w is wφ(x) to order w².
  const auto away = [&](double width) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(space.dofs);
    constexpr int pieces = 200;
    for (int i = 0; i < pieces; ++i)
      for (const auto& [dof, value] : displacement_row(space, x + width * ((i + 0.5) / pieces - 0.5)))
        mean[dof] += value / pieces;
    return (mean - assembled(of_terms({force_at(x, "1")}), space, 0)).norm();
  };
  CHECK(away(0.02) < 2e-3);
  CHECK(away(0.04) / away(0.02) == Approx(4).epsilon(0.01));
}

TEST_CASE("a separable load is f(x) g(t), assembled once") {
  BarSpec bar;
  bar.fixed = BarSpec::Fixed::left;
  const SceneSpec beam = unit_beam();
  for (const StructureSpec& structure : {StructureSpec(beam.structure), StructureSpec(bar)}) {
    const auto space = make_space(structure, 5);
    const LoadSpec parts = of_terms({separable("1 + x^2", "cos(5*t)"), separable("sin(x)", "3")});
    const LoadSpec whole = Formula("(1 + x^2)*cos(5*t) + 3*sin(x)", "");
    for (const double t : {0.0, 0.3, 7.1}) {
      const Eigen::VectorXd a = assembled(parts, space, t), b = assembled(whole, space, t);
      // Some twenty products and sums per entry.
      CHECK((a - b).lpNorm<Eigen::Infinity>() <= 1e-14 * b.lpNorm<Eigen::Infinity>());
    }
    const DistributedLoad load(parts, space);
    CHECK_FALSE(load.has_formula());
    CHECK(load.terms() == 2);
    CHECK_FALSE(load.constant_in_time());
  }
}

TEST_CASE("what does not change with time is known not to, and nothing is no load") {
  const auto space = make_space(unit_beam().structure, 2);
  CHECK(DistributedLoad(of_terms({force_at(1, "4"), separable("x", "2")}), space).constant_in_time());
  CHECK(DistributedLoad(of_terms({force_at(1, "0"), separable("0", "sin(t)")}), space).absent());
  CHECK(of_terms({force_at(1, "0"), separable("0", "sin(t)")}).is_zero());
  CHECK_FALSE(of_terms({separable("0", "sin(t)")}).uses_t());
  CHECK(of_terms({force_at(1, "sin(t)")}).uses_t());
}

TEST_CASE("an oscillator takes forces, which add to its own") {
  SceneSpec scene;
  scene.structure = OscillatorSpec{1, 4, 0, {5, 3, 0.2}};
  scene.load.terms.push_back({true, std::nullopt, {}, Formula("7*t", "/force", "t")});
  const auto made = discretise(scene, 1, *mass("consistent"));
  double force = 0;
  std::get<SemiDiscrete>(made).load->assemble(0.4, &force);
  CHECK(force == Approx(7 * 0.4 + 5 * std::cos(3 * 0.4 + 0.2)).epsilon(1e-14));
}

TEST_CASE("loads that act nowhere are refused where they stand") {
  const auto refused = [](SceneSpec scene, std::vector<LoadTerm> terms) -> std::string {
    scene.load.terms = std::move(terms);
    return input_error([&] { check_scene(scene, 1); });
  };
  const SceneSpec beam = unit_beam();
  CHECK(refused(beam, {separable("x", "t"), force_at(1.2, "1")}) ==
        "/scene/load/1/at: a force at x = 1.2 m is beyond the beam; expected 0 < x ≤ 1 m");
  CHECK_THAT(refused(beam, {force_at(0, "1")}), Contains("/scene/load/0/at: ") && Contains("is held"));
  CHECK_THAT(refused(beam, {{true, std::nullopt, {}, Formula(1.0)}}), Contains("/scene/load/0/at: missing"));
  CHECK_THAT(refused(beam, {separable("log(x-1)", "1")}), Contains("gives no number (NaN) at x = "));
  CHECK_THAT(refused(beam, {force_at(1, "1/t")}), Contains("infinite"));
  CHECK(refused(beam, {force_at(1, "-3"), separable("x", "t")}) == "no error");
  SceneSpec oscillator;
  oscillator.structure = OscillatorSpec{};
  CHECK_THAT(refused(oscillator, {separable("1", "t")}), Contains("/scene/load/0/shape: an oscillator has one point"));
  CHECK_THAT(refused(oscillator, {force_at(1, "t")}), Contains("/scene/load/0/at: an oscillator has one point"));
  CHECK(refused(oscillator, {{true, std::nullopt, {}, Formula("t", "", "t")}}) == "no error");
}
