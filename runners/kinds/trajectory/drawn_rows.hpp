#pragma once
#include <ricochet/scene/semi_discrete.hpp>

#include "runners/store/snapshots.hpp"

namespace ricochet {

/// What a film of a structure of files shows: nodes on a plane with what joins them; or, where no node has a place of
/// its own, a bar for each point.
struct DrawnRows {
  Snapshots shape;  ///< all that does not change, without stops' bounds
  SparseRows rows;  ///< of its values at an instant, on the dofs of the mesh
  /// What supports add to them, values × r: static modes there, and their own displacements.
  Eigen::MatrixXd on_supports;
};

/// Nothing for beams, bars and oscillators.
std::optional<DrawnRows> drawn_rows(const SceneSpec& scene, const SemiDiscrete& problem);

}  // namespace ricochet
