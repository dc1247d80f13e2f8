#include <catch2/catch.hpp>
#include <ricochet/scene/assembly.hpp>

#include "tests/eigen.hpp"
#include "tests/scene/working_set.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

/// Nodal values and slopes of a function at the free nodes.
template <class Value, class Slope>
Eigen::VectorXd interpolate(const FiniteElementSpace& space, Value value, Slope slope) {
  Eigen::VectorXd q(space.dofs);
  for (const auto& element : space.elements) {
    q[element.dof[2]] = value(element.left + element.length);
    q[element.dof[3]] = slope(element.left + element.length);
  }
  return q;
}

}  // namespace

TEST_CASE("shape functions: nodal values, rigid motions, derivatives") {
  using Basis = FiniteElementSpace::Basis;
  const double l = 0.3;
  CHECK(shape_values(Basis::hermite, l, 0) == std::array<double, 4>{1, 0, 0, 0});
  CHECK(shape_values(Basis::hermite, l, 1) == std::array<double, 4>{0, 0, 1, 0});
  for (auto basis : {Basis::hermite, Basis::linear}) {
    for (double xi : {0.1, 0.5, 0.87}) {
      const double d = 1e-3;
      const auto values = shape_values(basis, l, xi), strains = shape_strains(basis, l, xi);
      const auto after = shape_values(basis, l, xi + d), before = shape_values(basis, l, xi - d);
      CHECK(values[0] + (basis == Basis::hermite ? values[2] : values[1]) == Approx(1).epsilon(1e-15));
      for (std::size_t a = 0; a < 4; ++a) {
        // Differences of a cubic's second order, of a line's first, are exact but for round-off: 1e-16/(d ℓ)² = 1e-9.
        const double first = (after[a] - before[a]) / (2 * d * l);
        const double second = (after[a] - 2 * values[a] + before[a]) / (d * d * l * l);
        CHECK(strains[a] == Approx(basis == Basis::hermite ? second : first).margin(1e-8));
      }
    }
  }
}

TEST_CASE("Gauss points integrate polynomials of degree 7 on [0,1] exactly") {
  for (int degree = 0; degree <= 7; ++degree) {
    double sum = 0;
    for (const auto& [xi, weight] : gauss_points()) sum += weight * std::pow(xi, degree);
    CHECK(sum == Approx(1.0 / (degree + 1)).epsilon(1e-15));
  }
}

TEST_CASE("the space of a beam: clamped at 0, dofs node by node, half-bandwidth 3, last node exactly at L") {
  const auto space = make_space(working_set().structure, 7);
  CHECK(space.dofs == 14);
  REQUIRE(space.elements.size() == 7);
  CHECK(space.elements[0].dof == std::array<int, 4>{-1, -1, 0, 1});
  CHECK(space.elements[3].dof == std::array<int, 4>{4, 5, 6, 7});
  CHECK(space.left_fixed);
  CHECK_FALSE(space.right_fixed);
  CHECK(node_positions(1.501, 7).back() == 1.501);
  const SparseMatrix K = bending_stiffness(space, 1);
  for (int j = 0; j < K.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(K, j); it; ++it) CHECK(std::abs(it.row() - it.col()) <= 3);
}

TEST_CASE("K is symmetric, positive definite and the exact integral of EI φ''φ''") {
  const double EI = 3.7;
  const auto space = make_space(working_set().structure, 5);
  const Eigen::MatrixXd K = bending_stiffness(space, EI);
  CHECK((K - K.transpose()).cwiseAbs().maxCoeff() == 0);
  CHECK(eigen::is_definite(K));
  Eigen::MatrixXd integrated = Eigen::MatrixXd::Zero(space.dofs, space.dofs);
  for (const auto& element : space.elements)
    for (const auto& [xi, weight] : gauss_points()) {
      const auto strain = shape_strains(space.basis, element.length, xi);
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          if (element.dof[a] >= 0 && element.dof[b] >= 0)
            integrated(element.dof[a], element.dof[b]) += EI * element.length * weight * strain[a] * strain[b];
    }
  // Sums of four products each: a few ulps of the largest entry.
  CHECK((K - integrated).cwiseAbs().maxCoeff() <= 1e-14 * K.cwiseAbs().maxCoeff());
}

TEST_CASE("nodal values are exact in statics: tip of a cantilever under a uniform load, qL⁴/8EI") {
  for (int elements : {1, 3, 20}) {
    SceneSpec scene = unit_beam();
    scene.stops = {};
    scene.load = Formula(2.0);
    const auto problem = discretised(scene, elements, *mass("consistent"));
    Eigen::VectorXd F(problem.dofs());
    problem.load->assemble(0, F.data());
    const Eigen::VectorXd u = eigen::ldlt_solve(problem.stiffness, F);
    // Condition number of K (about 12 N⁴) times 1e-16.
    CHECK((problem.tip * u)(0) == Approx(2.0 / 8).epsilon(1e-10));
    CHECK(u[problem.dofs() - 1] == Approx(2.0 / 6).epsilon(1e-10));
  }
}

TEST_CASE("the distributed load equals its closed form, and its formula in time") {
  const auto space = make_space(unit_beam().structure, 4);
  const double l = 0.25;
  Eigen::VectorXd F(space.dofs);

  DistributedLoad(Formula(3.0), space).assemble(0, F.data());
  for (int node = 0; node < 4; ++node) {
    CHECK(F[2 * node] == Approx(node < 3 ? 3 * l : 3 * l / 2).epsilon(1e-14));
    CHECK(F[2 * node + 1] == Approx(node < 3 ? 0 : -3 * l * l / 12).epsilon(1e-13).margin(1e-15));
  }
  // Degree 4 times a cubic: still exact. Work on the interpolant of x² is ∫x⁴·x² = 1/7.
  const DistributedLoad quartic(Formula("x^4", ""), space);
  CHECK(quartic.constant_in_time());
  quartic.assemble(0, F.data());
  const auto square = interpolate(
      space, [](double x) { return x * x; }, [](double x) { return 2 * x; });
  CHECK(F.dot(square) == Approx(1.0 / 7).epsilon(1e-14));

  const DistributedLoad pulsating(Formula("x*cos(5*t)", ""), space);
  CHECK_FALSE(pulsating.constant_in_time());
  Eigen::VectorXd at_rest(space.dofs);
  pulsating.assemble(0, at_rest.data());
  pulsating.assemble(0.3, F.data());
  CHECK((F - std::cos(1.5) * at_rest).norm() <= 1e-14 * at_rest.norm());

  const DistributedLoad none(Formula("0", ""), space);
  CHECK(none.absent());
  F.setConstant(9);
  none.assemble(0, F.data());
  CHECK(F.norm() == 0);
}

TEST_CASE("a load that stops being finite is passed on to the lane that meets it") {
  const auto space = make_space(unit_beam().structure, 2);
  Eigen::VectorXd F(space.dofs);
  DistributedLoad(Formula("1/(1-t)", ""), space).assemble(1, F.data());
  CHECK_FALSE(F.allFinite());
}

TEST_CASE("the inertia load of the support is ∫ρS φ_i: consistent mass times the rigid translation") {
  const auto space = make_space(working_set().structure, 6);
  const auto s = rigid_motion_load(space);
  Eigen::VectorXd integrated(space.dofs);
  DistributedLoad(Formula(space.elements[0].line_density), space).assemble(0, integrated.data());
  CHECK((s - integrated).norm() <= 1e-14 * s.norm());
  // Translations of the free nodes carry the beam's mass but for the clamped node's share, half an element.
  double total = 0;
  for (int i = 0; i < space.dofs; i += 2) total += s[i];
  const auto& element = space.elements[0];
  CHECK(total == Approx(element.line_density * (1.501 - element.length / 2)).epsilon(1e-14));
}

TEST_CASE("displacement rows: exact on cubics inside elements, the nodal row on a node") {
  const auto space = make_space(unit_beam().structure, 5);
  const auto cubic = interpolate(
      space, [](double x) { return x * x * (3 - 2 * x); }, [](double x) { return 6 * x * (1 - x); });
  for (double x : {0.01, 0.123, 0.35, 0.9999}) {
    const auto row = displacement_rows(space, {x});
    CHECK((row * cubic)(0) == Approx(x * x * (3 - 2 * x)).epsilon(1e-13));
  }
  for (int node = 1; node <= 5; ++node) {
    const auto row = displacement_row(space, 0.2 * node);
    REQUIRE(row.size() == 1);
    CHECK(row[0] == std::pair<int, double>{2 * node - 2, 1.0});
  }
  CHECK(displacement_row(space, 0.3).size() == 4);
  CHECK(displacement_row(space, 0.1).size() == 2);
}
