#pragma once
#include <optional>
#include <ricochet/scene/scene.hpp>
#include <vector>

#include "runners/study/study.hpp"

namespace ricochet {

/// The bases of modes that a study marches in, out of its `mesh`: mesh.modes times mesh.residual; one that is empty
/// where all dofs march. `modal`: whether the structure is described by modes, whose residual may be left out alone.
/// Throws InputError at /mesh/residual for a residual of no modes.
std::vector<std::optional<BasisSpec>> bases_of(const Json& mesh, const Json& scene, bool modal);

/// Throws InputError at /mesh/modes for more modes than the structure has dofs on one of the meshes.
void check_bases(const std::vector<std::optional<BasisSpec>>& bases, const Json& mesh, const StructureSpec& structure,
                 int coarsest);

/// Throws InputError at /scene/structure for matrices of more than 20 000 dofs, with the time of a step that the cost
/// model predicts.
void check_size(const StructureSpec& structure);

}  // namespace ricochet
