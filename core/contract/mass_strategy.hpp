#pragma once
#include <Eigen/SparseCore>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/finite_element_space.hpp>
#include <variant>

namespace ricochet {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The mass matrix, symmetric positive semidefinite, in one of two forms.
///   assembled:  M as a sparse n × n matrix (both triangles stored)
///   factored:   M = Bᵀ C_v⁻¹ B with B (N_v × n), B_ij = ∫ρS ψ_i φ_j, C_v (N_v × N_v, SPD) = ∫ρS ψψ, when C_v⁻¹ is full
///   and M
///               must never be formed on the marching path
struct Inertia {
  SparseMatrix mass;           ///< empty (0×0) when factored
  SparseMatrix coupling;       ///< B
  SparseMatrix velocity_mass;  ///< C_v
  int kernel_dimension = 0;    ///< dim Ker M
  bool factored() const { return coupling.rows() > 0; }
};

using InertiaOrRefusal = std::variant<Inertia, Refusal>;

/// How velocities are discretised, hence the mass matrix.
class MassStrategy {
 public:
  virtual ~MassStrategy() = default;
  virtual InertiaOrRefusal build(const FiniteElementSpace& space) const = 0;
};

/// B_ij = ∫ρS ψ_i φ_j and M_ij = ∫ρS φ_i φ_j helpers shared by strategies: the consistent matrix of the space, point
/// masses included.
SparseMatrix consistent_mass(const FiniteElementSpace& space);

}  // namespace ricochet
