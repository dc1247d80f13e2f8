#pragma once
#include <ricochet/contract/plugin.hpp>

namespace ricochet {

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
