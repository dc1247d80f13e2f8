#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <utility>
#include <vector>

/// \file
/// Set-up pieces that discretise() is made of; nothing here runs while marching.
namespace ricochet {

/// K_ij = ∫EI φ_i'' φ_j'' dx (n × n, both triangles) for a Hermite space, EI in N m². Elements that deform in shear
/// have ∫EI θ_i' θ_j' + kGA (w_i' − θ_i)(w_j' − θ_j) dx.
SparseMatrix bending_stiffness(const FiniteElementSpace& space, double EI);
/// The same with an EI per element.
SparseMatrix bending_stiffness(const FiniteElementSpace& space, const std::vector<double>& EI);

/// K_ij = ∫EA φ_i' φ_j' dx (n × n, both triangles) for a linear space; EA in N.
SparseMatrix axial_stiffness(const FiniteElementSpace& space, double EA);

/// Where each dof stands and what it is: the displacement there, or (Hermite) its slope; of which plane.
struct DofPlace {
  double x = 0;
  bool slope = false;
  bool across = false;  ///< along z
};
std::vector<DofPlace> dof_places(const FiniteElementSpace& space);

/// s_i = ∫ρS φ_i dx (kg on displacements, kg m on rotations) plus the point masses. The inertia load of a support that
/// accelerates by a is −a s.
Eigen::VectorXd rigid_motion_load(const FiniteElementSpace& space);

/// The displacement at x as Σ value·q_dof, eliminated dofs left out. An x within 1e-10 of an element's length from a
/// node is that node: one entry, exactly 1. Without elements the only dof is everywhere.
/// Of a beam also: the rotation of its section θ, rad; its curvature θ', 1/m; and θ'', 1/m².
enum class ShapeOf { displacement, rotation, curvature, curvature_slope };
std::vector<std::pair<int, double>> displacement_row(const FiniteElementSpace& space, double x,
                                                     ShapeOf what = ShapeOf::displacement);

/// What displacement_row() leaves out. For each end of an element whose displacement is held: where it is (m) and its
/// share of the displacement at x.
std::vector<std::pair<double, double>> held_row(const FiniteElementSpace& space, double x,
                                                ShapeOf what = ShapeOf::displacement);

/// Rows of displacement_row() for each x (m × n).
Eigen::SparseMatrix<double, Eigen::RowMajor> displacement_rows(const FiniteElementSpace& space,
                                                               const std::vector<double>& x);

/// The derivative that strains the structure at x: w_xx (Hermite; θ' with shear) or w_x (linear). At a node it is that
/// of the element to its right, at the end to its left.
std::vector<std::pair<int, double>> strain_row(const FiniteElementSpace& space, double x);

/// Positions of the nodes of equal elements, x_0 = 0 to x_N = L; the last is exactly L.
std::vector<double> node_positions(double length, int elements);

}  // namespace ricochet
