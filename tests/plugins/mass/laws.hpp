#pragma once
#include <ricochet/scene/assembly.hpp>

#include "tests/eigen.hpp"
#include "tests/scene/working_set.hpp"

/// \file
/// What every mass strategy must satisfy on a beam, and frequencies of the unit beam.
namespace ricochet::testing {

/// Symmetric, positive semidefinite, kernel of the dimension declared.
inline void check_inertia(const MassStrategy& strategy, int elements, int kernel) {
  const auto space = make_space(working_set().structure, elements);
  const auto inertia = built(strategy, space);
  CHECK(inertia.kernel_dimension == kernel);
  if (inertia.factored()) {
    CHECK(inertia.coupling.cols() == space.dofs);
    CHECK(inertia.velocity_mass.rows() == inertia.coupling.rows());
    const Eigen::MatrixXd C = inertia.velocity_mass;
    CHECK((C - C.transpose()).cwiseAbs().maxCoeff() == 0);
    CHECK(eigen::is_definite(C));
  } else {
    const Eigen::MatrixXd M = inertia.inverted() ? inertia.inverse : inertia.mass;
    CHECK((M - M.transpose()).cwiseAbs().maxCoeff() == 0);
  }
  // Rotations in radians times ℓ, so that all entries of M are of the size of an element's mass.
  Eigen::MatrixXd M = dense_mass(inertia);
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(space.dofs);
  for (int i = 1; i < space.dofs; i += 2) scale[i] = 1 / space.elements[0].length;
  M = scale.asDiagonal() * M * scale.asDiagonal();
  const Eigen::VectorXd values = eigen::values(M);
  const double largest = values.maxCoeff();
  // Round-off of an eigenvalue: 1e-16 of the largest, times the dimension. The smallest true ones are above 1e-4.
  CHECK(values.minCoeff() >= -1e-13 * largest);
  CHECK((values.array() <= 1e-10 * largest).count() == kernel);
}

/// (βL)² of the first mode of the unit beam.
inline double first_pulsation(const MassStrategy& strategy, int elements) {
  const auto scene = unit_beam();
  const auto p = discretised(scene, elements, strategy);
  return 1 / std::sqrt(compliances(p.stiffness, p.inertia).maxCoeff());
}

/// Order in ℓ of the first pulsation's error over 10, 20, 40 elements.
inline double pulsation_order(const MassStrategy& strategy) {
  const double exact = 1.8751040687119611664 * 1.8751040687119611664;
  std::vector<double> lengths, errors;
  for (int elements : {10, 20, 40}) {
    lengths.push_back(-std::log(elements));
    errors.push_back(std::log(std::abs(first_pulsation(strategy, elements) - exact)));
  }
  return fitted_slope(lengths, errors);
}

/// Largest finite eigenvalue of K x = λ M x in units of EI/(ρSℓ⁴).
inline double largest_eigenvalue(const MassStrategy& strategy, int elements) {
  const auto p = discretised(unit_beam(), elements, strategy);
  return 1 / compliances(p.stiffness, p.inertia)[p.inertia.kernel_dimension] / std::pow(elements, 4);
}

/// EA = ρA = L = 1, fixed at x = 1, without stops or with one at its free end: pulsations (k − ½)π.
inline SceneSpec unit_bar(bool stop = false) {
  SceneSpec scene;
  scene.structure = BarSpec{.length = 1, .EA = 1, .rhoA = 1, .fixed = BarSpec::Fixed::right, .damping = {}};
  scene.stops.place = StopsSpec::Place::tip;
  if (stop) scene.stops.lower = Formula(-1.0);
  return scene;
}

/// Relative error of the first pulsation, with its sign.
inline double pulsation_error(const MassStrategy& strategy, const SceneSpec& scene, int elements) {
  const auto p = discretised(scene, elements, strategy);
  const bool bar = std::holds_alternative<BarSpec>(scene.structure);
  const double exact = bar ? 1.57079632679489661923 : 1.8751040687119611664 * 1.8751040687119611664;
  return 1 / std::sqrt(compliances(p.stiffness, p.inertia).maxCoeff()) / exact - 1;
}

/// Its order in ℓ from one mesh to one of twice as many elements.
inline double pulsation_order(const MassStrategy& strategy, const SceneSpec& scene, int elements) {
  return std::log2(
      std::abs(pulsation_error(strategy, scene, elements) / pulsation_error(strategy, scene, 2 * elements)));
}

/// The largest finite pulsation in units of c/ℓ (bar) or √(EI/ρS)/ℓ² (beam); explicit steps end at 2/ω.
inline double largest_pulsation(const MassStrategy& strategy, const SceneSpec& scene, int elements) {
  const auto p = discretised(scene, elements, strategy);
  const bool bar = std::holds_alternative<BarSpec>(scene.structure);
  const double slowest = compliances(p.stiffness, p.inertia)[p.inertia.kernel_dimension];
  return 1 / std::sqrt(slowest) / std::pow(elements, bar ? 1 : 2);
}

/// Mass, first and second moment about the left end that the free dofs have: XᵀMX of the rigid motions.
inline Eigen::Matrix2d rigid_mass(const Inertia& inertia, const FiniteElementSpace& space) {
  const auto places = dof_places(space);
  Eigen::MatrixXd X(space.dofs, 2);
  for (int i = 0; i < space.dofs; ++i) {
    const auto [x, slope, across] = places[static_cast<std::size_t>(i)];
    REQUIRE_FALSE(across);
    X.row(i) << (slope ? 0.0 : 1.0), (slope ? 1.0 : x);
  }
  return X.transpose() * dense_mass(inertia) * X;
}

/// One point mass and no element: an oscillator.
inline FiniteElementSpace oscillator_space(double mass) {
  FiniteElementSpace space;
  space.structure = "oscillator";
  space.dofs = 1;
  space.point_masses = {{0, mass}};
  return space;
}

/// Linear elements on (0, 1), fixed at x = 1, unit density.
inline FiniteElementSpace bar_space(int elements) {
  FiniteElementSpace space;
  space.structure = "bar";
  space.basis = FiniteElementSpace::Basis::linear;
  space.dofs = elements;
  space.right_fixed = true;
  for (int e = 0; e < elements; ++e)
    space.elements.push_back({1.0 * e / elements, 1.0 / elements, 1.0, {e, e + 1 < elements ? e + 1 : -1, -1, -1}});
  return space;
}

}  // namespace ricochet::testing
