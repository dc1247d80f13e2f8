#pragma once
#include <Eigen/Core>

namespace ricochet {

/// Modes of a structure some of whose displacements are held at zero.
struct ConstrainedModes {
  Eigen::VectorXd mass;   ///< m, ascending
  Eigen::MatrixXd basis;  ///< Ψ, n × m
};

/// Ψ and m with C Ψ = 0, ΨᵀΨ = 1, Ψᵀ diag(d) Ψ = diag(m), from the modes of the free structure (K = 1, M = diag(d)):
/// `mass` d ≥ 0 (n), `rows` C (k × n, independent, k < n). One row c after the other: with the poles d_j the new masses
/// are the zeros of the secular equation, one between any two of them,
///
///     f(ν) = Σ_j c_j² / (d_j − ν) = 0,     ψ_j = c_j / (d_j − ν)
///
/// (Golub, Some modified matrix eigenvalue problems, SIAM Review 15, 1973, §5), found from the nearer pole, so that
/// each d_j − ν has its digits whatever the sizes of masses; vectors are those of the c of which the zeros found are
/// exact (Gu and Eisenstat, SIAM J. Matrix Anal. Appl. 15, 1994, §3), orthogonal to round-off. Poles that coincide are
/// turned until one c is left. n² operations per row, and n²(n − k) from the second on.
ConstrainedModes constrained_modes(const Eigen::VectorXd& mass, const Eigen::MatrixXd& rows);

}  // namespace ricochet
