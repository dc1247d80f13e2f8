#pragma once
#include <Eigen/Core>

/// \file
/// Eigenvalues of dense matrices, compiled once: Eigen's own solvers are templates that every user would compile again.
namespace ricochet {

/// Modes of a symmetric problem: values ascending, one column of `vectors` per value (none where they were not asked
/// for). `found` is false where the iteration did not converge or B is not positive definite; then nothing is said.
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  bool found = false;
};

enum class EigenVectors { wanted, none };

/// A φ = λ φ, A n × n symmetric (its lower half is read); φᵀφ = 1. (Householder tridiagonalisation and implicit QR.)
SymmetricModes symmetric_modes(const Eigen::MatrixXd& A, EigenVectors vectors = EigenVectors::wanted);

/// A φ = λ B φ, A and B n × n symmetric, B positive definite; φᵀBφ = 1. (Cholesky of B, then as above.)
SymmetricModes symmetric_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                               EigenVectors vectors = EigenVectors::wanted);

/// Modes of a general real matrix, in the order in which the iteration finds them; complex ones in conjugate pairs.
struct GeneralModes {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  bool found = false;
};

/// A φ = λ φ, A n × n. (Hessenberg form and shifted QR.)
GeneralModes general_modes(const Eigen::MatrixXd& A, EigenVectors vectors = EigenVectors::wanted);

/// Singular values of A, descending (one-sided Jacobi, accurate to round-off of the largest).
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);
Eigen::VectorXd singular_values(const Eigen::MatrixXcd& A);

/// A becomes D⁻¹ A D, with rows and columns of about the same size (Parlett and Reinsch 1969). Returns D, of powers of
/// two. Eigenvalues stay, and are found more accurately. Rows and columns whose sizes differ by more than 1 :
/// `negligible` are left alone. Against round-off there is nothing to balance, and a defective matrix would look
/// diagonal.
Eigen::VectorXd balance(Eigen::MatrixXd& A, double negligible = 1e-13);

/// Modes of a structure some of whose displacements are held at zero.
struct ConstrainedModes {
  Eigen::VectorXd mass;   ///< m, ascending
  Eigen::MatrixXd basis;  ///< Ψ, n × m
};

/// Ψ and m with C Ψ = 0, ΨᵀΨ = 1, Ψᵀ diag(d) Ψ = diag(m), from the modes of the free structure (K = 1, M = diag(d)):
/// `mass` d ≥ 0 (n), `rows` C (k × n, independent, k < n). One row c is taken after the other. With the poles d_j the
/// new masses are the zeros of the secular equation, one between any two of them,
///
///     f(ν) = Σ_j c_j² / (d_j − ν) = 0,     ψ_j = c_j / (d_j − ν)
///
/// (Golub, Some modified matrix eigenvalue problems, SIAM Review 15, 1973, §5). Zeros are found from the nearer pole:
/// each d_j − ν has its digits whatever the sizes of masses. Vectors are those of the c of which the zeros found are
/// exact (Gu and Eisenstat, SIAM J. Matrix Anal. Appl. 15, 1994, §3), orthogonal to round-off. Poles that coincide are
/// turned until one c is left. n² operations per row, and n²(n − k) from the second on.
ConstrainedModes constrained_modes(const Eigen::VectorXd& mass, const Eigen::MatrixXd& rows);

}  // namespace ricochet
