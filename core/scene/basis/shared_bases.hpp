#pragma once
#include <memory>
#include <ricochet/scene/basis/modal_basis.hpp>

namespace ricochet {

/// modal_basis(), made once for equal matrices, stops and choice of modes: those of the cases of a study that differ in
/// methods or steps alone. What it depends on is compared bit by bit, so that results are those of a basis of its own.
/// A process keeps the bases used last, up to 128 MB of them with what they were made of; at least one is kept.
std::shared_ptr<const ModalBasis> shared_basis(const SparseMatrix& stiffness, const SparseMatrix& mass,
                                               const SparseRows& contact, bool definite, const BasisSpec& spec);

/// How many bases this process has made, and how many it keeps.
struct BasisCount {
  long long made = 0;
  std::size_t kept = 0;
};
BasisCount basis_count();

}  // namespace ricochet
