#pragma once
#include <ricochet/scene/semi_discrete.hpp>

#include "runners/store/snapshots.hpp"

namespace ricochet {

/// What a film shows of a structure: places of a beam, a bar or an oscillator, or nodes on a plane with what joins
/// them. Bodies and beams in two planes are nodes as well. Where no node has a place of its own, each point is a bar.
struct DrawnRows {
  Snapshots shape;  ///< all that does not change, with a stop for each contact point, without bounds
  SparseRows rows;  ///< of its values at an instant, on the dofs of the mesh
  /// What supports add to them, values × r: static modes there, and their own displacements.
  Eigen::MatrixXd on_supports;
  Eigen::VectorXd by_clamp;  ///< how much of the harmonic motion of all supports each value has
};
DrawnRows drawn_rows(const SceneSpec& scene, const SemiDiscrete& problem);

}  // namespace ricochet
