#pragma once
#include <ricochet/contract/finite_element_space.hpp>
#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The structure and its contact points before anything marches, for laws to which the displacement of a point is not
/// enough. Such a law replaces H by G and K by K':
///
///     M q'' + (αK' + ηM) q' + K' q = F(t) + Gᵀ p,     p = Φ(lower − G q) − Φ(G q − upper)
///
/// q is relative to the clamp; G must report a rigid translation as it is, as H does. Where the points are, penetration
/// and the dates of impacts are those of H, whatever the law measures.
struct ContactStructure {
  const FiniteElementSpace* space = nullptr;
  double rigidity = 0;                  ///< EI of a beam (N m²), EA of a bar (N), k of an oscillator (N/m)
  const SparseRows* contact = nullptr;  ///< H (m × n), displacements of the contact points
  SparseRows measured;                  ///< in: H; out: G (m × n)
  SparseMatrix stiffness;               ///< in: K; out: K', symmetric positive (semi)definite, n × n, both triangles
};

}  // namespace ricochet
