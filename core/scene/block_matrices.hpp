#pragma once
#include <ricochet/contract/mass_strategy.hpp>
#include <vector>

/// \file
/// Matrices of several parts (planes of a beam, bodies): the unknowns of a part stand at given places among all, and
/// parts share none.
namespace ricochet {

using MatrixEntries = std::vector<Eigen::Triplet<double>>;

/// Entries of a block: its row i stands at rows[i], its column j at columns[j].
void add_block(const SparseMatrix& block, const std::vector<int>& rows, const std::vector<int>& columns,
               MatrixEntries& entries);

SparseMatrix sparse_matrix(Eigen::Index rows, Eigen::Index columns, const MatrixEntries& entries);

/// first, first + 1, …
std::vector<int> numbered_from(int first, Eigen::Index count);

/// M of `size` unknowns from those of its parts; part k has its unknowns at unknowns[k]. Where all parts are matrices M
/// is one, where all are inverses M⁻¹ is. Else M = Bᵀ C_v⁻¹ B, rows of B by the first unknown that they touch; a part
/// that is a matrix has B = C_v = M, and must be regular.
Inertia join_inertias(const std::vector<Inertia>& parts, const std::vector<std::vector<int>>& unknowns,
                      Eigen::Index size);

}  // namespace ricochet
