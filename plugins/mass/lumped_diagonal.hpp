#pragma once
#include <ricochet/contract/plugin.hpp>

namespace ricochet {

/// What one end of an element carries (Hinton, Rock and Zienkiewicz 1976). A translation carries half the element's
/// mass. The rotation of a Hermite element carries its consistent diagonal scaled alike: ρSℓ(156, 4ℓ², 156, 4ℓ²)/420
/// gives ρSℓ³/78. With shear or rotary inertia their consistent diagonal is scaled alike.
inline double lumped_share(const FiniteElementSpace& space, const FiniteElementSpace::Element& element, int function) {
  const double mass = element.line_density * element.length;
  if (element.shear != 0 || element.rotary != 0) {
    FiniteElementSpace alone;
    alone.basis = space.basis;
    alone.dofs = 4;
    alone.elements = {element};
    alone.elements.front().dof = {0, 1, 2, 3};
    const Eigen::VectorXd diagonal = consistent_mass(alone).diagonal();
    return mass * diagonal[function] / (diagonal[0] + diagonal[2]);
  }
  const bool rotation = space.basis == FiniteElementSpace::Basis::hermite && function % 2 == 1;
  return rotation ? mass * element.length * element.length / 78 : mass / 2;
}

/// The diagonal of all elements and point masses; rotations without inertia where they shall have none.
inline Eigen::VectorXd lumped_diagonal(const FiniteElementSpace& space, bool rotations) {
  const bool hermite = space.basis == FiniteElementSpace::Basis::hermite;
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(space.dofs);
  for (const auto& element : space.elements)
    for (int a = 0; a < space.functions(); ++a)
      if (element.dof[a] >= 0 && (rotations || !hermite || a % 2 == 0))
        diagonal[element.dof[a]] += lumped_share(space, element, a);
  for (const auto& point : space.point_masses) diagonal[point.dof] += point.mass;
  return diagonal;
}

/// A diagonal mass matrix; its kernel are the dofs without mass.
inline Inertia diagonal_inertia(const Eigen::VectorXd& diagonal) {
  Inertia inertia;
  const auto dofs = static_cast<int>(diagonal.size());
  inertia.mass.resize(dofs, dofs);
  for (int i = 0; i < dofs; ++i) {
    if (diagonal[i] == 0) ++inertia.kernel_dimension;
    if (diagonal[i] != 0) inertia.mass.insert(i, i) = diagonal[i];
  }
  inertia.mass.makeCompressed();
  return inertia;
}

/// The diagonal of a mass that is given, M_ii times a factor of its direction. Along x, y, z the factor makes the sum
/// the mass that a translation moves. Rotations have that of the directions, together, whose displacements M couples
/// with them; of all, where it couples none. A refusal where a dof with mass is neither, or a direction would lose its
/// mass.
inline std::variant<Eigen::VectorXd, Refusal> given_diagonal(const GivenMass& given) {
  constexpr int rotation = 3;
  const auto direction = [&](Eigen::Index dof) { return given.direction[static_cast<std::size_t>(dof)]; };
  Eigen::VectorXd diagonal = given.mass.diagonal();
  std::array<bool, 3> bends{};
  for (int j = 0; j < given.mass.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(given.mass, j); it; ++it)
      if (it.value() != 0 && direction(it.row()) == rotation && direction(j) >= 0 && direction(j) < rotation)
        bends[static_cast<std::size_t>(direction(j))] = true;
  const bool none = bends == std::array<bool, 3>{};
  std::array<double, 4> whole{}, own{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    whole[axis] = given.translated[axis];
    own[axis] = given.diagonal[axis];
    if (none || bends[axis]) {
      whole[rotation] += whole[axis];
      own[rotation] += own[axis];
    }
  }
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (diagonal[i] == 0) continue;
    if (direction(i) < 0)
      return Refusal{
          "a diagonal mass needs displacements along x, y, z and rotations, and the structure has dofs of another "
          "name: use consistent or redistributed"};
    const auto k = static_cast<std::size_t>(direction(i));
    if (!(whole[k] > 0) || !(own[k] > 0))
      return Refusal{"no translation moves mass in a direction in which dofs have some: use the mass consistent"};
    diagonal[i] *= whole[k] / own[k];
  }
  return diagonal;
}

}  // namespace ricochet
