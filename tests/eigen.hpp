#pragma once
#include <Eigen/Core>

/// \file
/// What tests ask of Eigen's dense factorisations, compiled once: templates that every file would compile again take
/// longer than anything else in it. A second opinion beside core/kernels, which these do not call.
namespace eigen {

/// A⁻¹ b and A⁻¹ B, A symmetric (LDLᵀ).
Eigen::VectorXd ldlt_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd ldlt_solve_all(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// A⁻¹ b, fully pivoted.
Eigen::VectorXd lu_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
/// Whether A = L Lᵀ.
bool is_definite(const Eigen::MatrixXd& A);
/// Of A to round-off.
Eigen::Index rank(const Eigen::MatrixXd& A);
/// Q of A = Q R.
Eigen::MatrixXd orthogonal(const Eigen::MatrixXd& A);
/// Of a symmetric A, ascending.
Eigen::VectorXd values(const Eigen::MatrixXd& A);

/// A φ = λ B φ, λ ascending, φᵀBφ = 1.
struct Modes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
Modes modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace eigen
