#pragma once
#include <Eigen/SparseCore>
#include <ricochet/contract/errors.hpp>
#include <ricochet/contract/finite_element_space.hpp>
#include <variant>

namespace ricochet {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The mass matrix, symmetric positive semidefinite, in one of three forms; the matrices of the others stay empty
/// (0×0).
///   assembled:  M as a sparse n × n matrix (both triangles stored)
///   factored:   M = Bᵀ C_v⁻¹ B with B (N_v × n), B_ij = ∫ρS ψ_i φ_j, C_v (N_v × N_v, SPD) = ∫ρS ψψ, when C_v⁻¹ is full
///               and M must never be formed on the marching path
///   inverse:    M⁻¹ as a sparse n × n matrix, SPD (both triangles stored), when M is full: an explicit stage is then a
///               product with it
struct Inertia {
  SparseMatrix mass;           ///< M
  SparseMatrix coupling;       ///< B
  SparseMatrix velocity_mass;  ///< C_v
  SparseMatrix inverse;        ///< M⁻¹
  int kernel_dimension = 0;    ///< dim Ker M; 0 of the inverse form
  bool factored() const { return coupling.rows() > 0; }
  bool inverted() const { return inverse.rows() > 0; }
  bool assembled() const { return !factored() && !inverted(); }
};

/// B and C_v of an inertia that is not assembled; those of the inverse form are I and M⁻¹.
struct MassFactors {
  SparseMatrix coupling, velocity_mass;
};
MassFactors mass_factors(const Inertia& inertia);

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
