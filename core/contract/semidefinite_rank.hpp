#pragma once
#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {

/// Rank of a symmetric positive semidefinite A (n × n), rows and columns scaled by D = diag(A)^{-1/2} first so that no
/// unit matters: how many eigenvalues of D A D are above 1e-11. By Sylvester's law of inertia these are the positive
/// pivots of D A D − 1e-11 I = L Δ Lᵀ, at the cost of one sparse factorisation in the order given.
int semidefinite_rank(const SparseMatrix& A);

/// Rank of B (any shape): that of B̂ B̂ᵀ, its columns scaled to length 1; singular values below 3e-6 of the largest row
/// count as zero.
int row_rank(const SparseMatrix& B);

}  // namespace ricochet
