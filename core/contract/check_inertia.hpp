#pragma once
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <string>

namespace ricochet {

/// What is wrong with an inertia on its space, or nothing. With D = diag(M)^{-1/2}, which makes rotations and
/// displacements comparable whatever the mesh, it must hold that
///
///     M is n × n (factored: B is N_v × n, C_v is N_v × N_v), finite, M_ii ≥ 0;
///     D M D is symmetric to 1e-12 of its norm, and D M D + 1e-11 I positive definite (factored: D C_v D − 1e-12 I);
///     rank M = n − kernel_dimension (semidefinite_rank()).
///
/// The cost is that of three band factorisations.
std::optional<std::string> check_inertia(const Inertia& inertia, const FiniteElementSpace& space);

}  // namespace ricochet
