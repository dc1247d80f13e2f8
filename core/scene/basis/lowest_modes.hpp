#pragma once
#include <Eigen/Core>
#include <ricochet/contract/mass_strategy.hpp>

namespace ricochet {

/// The N slowest modes of K φ = ω² M φ, ascending, ΦᵀMΦ = 1; those without mass are none.
struct LowestModes {
  Eigen::VectorXd squares;  ///< ω², N, s⁻²; 0 of a rigid motion
  Eigen::MatrixXd shapes;   ///< Φ, n × N
  double shift = 0;         ///< σ of K + σM, s⁻²: 0 where K is positive definite
  bool found = false;       ///< false where the iteration did not converge, or fewer modes have mass
  int with_mass = 0;        ///< how many modes have mass, where they were counted; else n
};

/// K positive semidefinite, M too, K + M definite. Solves M φ = μ (K + σM) φ with φᵀ(K + σM)φ = 1, ω² = 1/μ − σ, so
/// that slow modes are the accurate ones. σ = 0 where `definite`; else first 1e-6 of the median of K_ii/M_ii, then the
/// least elastic ω² found with it. Dense up to 1000 dofs; beyond by Lanczos with a sparse factor (Spectra), ended by a
/// Rayleigh–Ritz step.
LowestModes lowest_modes(const SparseMatrix& stiffness, const SparseMatrix& mass, int count, bool definite);

/// With σ the least elastic ω², 1 − σμ is 0 of a rigid motion and ½ or more of an elastic one.
inline constexpr double rigid_mode = 1e-3;

/// σ for a structure that moves rigidly: the least elastic ω² (s⁻²), K + σM being definite. `massless`: dimension of
/// Ker M.
double elastic_shift(const SparseMatrix& stiffness, const SparseMatrix& mass, int massless);

}  // namespace ricochet
