#pragma once
#include <Eigen/Core>
#include <array>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/scene/assembly.hpp>
#include <ricochet/scene/beam.hpp>
#include <ricochet/scene/formula.hpp>
#include <ricochet/scene/place.hpp>
#include <string>
#include <vector>

/// \file
/// Beams that move along y and z: two beams of one plane each, side by side. Plane 0 bends along y, plane 1 along z.
/// Dofs stand node by node, (w_y, w_y', w_z, w_z'), those that a support holds left out: half-bandwidth 7.
namespace ricochet {

/// Displacement components of a beam in two planes.
inline constexpr std::array<const char*, 2> plane_components = {"uy", "uz"};

/// The beam of one plane: its EI there, and what its supports hold there. A support that holds nothing there stays in
/// the list, and keeps its node.
BeamSpec in_plane(const BeamSpec& beam, int plane);

/// A plane of a joint space, with dofs 0, 1, … of its own.
struct PlaneSpace {
  FiniteElementSpace space;
  std::vector<int> dofs;  ///< joint number of each of them, ascending
};
PlaneSpace plane_space(const FiniteElementSpace& joint, int plane);

/// The same plane with the dofs of the joint space; of a space of one plane, that space as it is.
FiniteElementSpace plane_elements(const FiniteElementSpace& joint, int plane);

FiniteElementSpace join_planes(const FiniteElementSpace& along_y, const FiniteElementSpace& along_z);
/// Square matrices of the planes of a joint space.
SparseMatrix join_planes(const FiniteElementSpace& joint, const std::array<SparseMatrix, 2>& planes);
/// Columns of the supports of plane 0, then those of plane 1.
StaticModes join_planes(const FiniteElementSpace& joint, const std::array<StaticModes, 2>& planes);

/// A mass made of each plane by itself. What refuses a plane refuses the beam.
InertiaOrRefusal mass_by_plane(const MassStrategy& mass, const FiniteElementSpace& joint);

/// Shares of u_y and u_z in the displacement that a place of a beam means. They are (1, 0) unless it says a component
/// or a direction, which is normalised. Throws InputError below `pointer` for another word and a direction without
/// length. Where the structure moves in one plane, also for uz and a direction that is not along y.
std::array<double, 2> plane_shares(const Place& place, bool two_planes, const std::string& pointer);

/// u_z, or its slope, of a formula at a dof of a beam of this length.
double initial_across(const Formula& formula, const DofPlace& place, double length);

}  // namespace ricochet
