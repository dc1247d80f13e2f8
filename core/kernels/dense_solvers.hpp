#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

/// \file
/// Factorisations of dense matrices, compiled once: Eigen's own are templates that every user would compile again.
namespace ricochet {

/// Q of A = Q R, n × n orthogonal, by Householder reflections.
Eigen::MatrixXd householder_basis(const Eigen::MatrixXd& A);
/// Its first columns, as many as A has: Q applied to them.
Eigen::MatrixXd householder_columns(const Eigen::MatrixXd& A);

/// Q of A P = Q R with pivoted columns, n × n, and the rank of A to round-off. Columns of Q behind the rank are
/// orthogonal to those of A.
struct PivotedBasis {
  Eigen::MatrixXd basis;
  Eigen::Index rank = 0;
};
PivotedBasis pivoted_basis(const Eigen::MatrixXd& A);

/// Whether the symmetric A has a Cholesky factor.
bool is_definite(const Eigen::MatrixXd& A);
/// A⁻¹ B, A symmetric and positive definite.
Eigen::MatrixXd definite_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
/// L⁻¹ B, A = L Lᵀ.
Eigen::MatrixXd cholesky_forward(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A factorised with partial pivoting: solves A X = B for any number of B. A that is singular gives what is not finite.
class DenseLu {
 public:
  DenseLu();
  explicit DenseLu(const Eigen::MatrixXd& A);
  DenseLu(DenseLu&&) noexcept;
  DenseLu& operator=(DenseLu&&) noexcept;
  ~DenseLu();
  void compute(const Eigen::MatrixXd& A);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

/// A⁻¹ and |A|, with partial pivoting.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& A);
double determinant(const Eigen::MatrixXd& A);
/// A⁻¹ b, fully pivoted; nothing where A has not full rank to round-off.
std::optional<Eigen::VectorXd> regular_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
std::optional<Eigen::VectorXcd> regular_solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);
/// A⁻¹ b, fully pivoted; where A has not full rank, one that solves best what can be solved.
Eigen::VectorXd pivoted_solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::VectorXcd pivoted_solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);
/// The x that solves A x = b best, by QR with pivoted columns; A has full rank.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
/// The least X that solves A X = B best, whatever the rank of A.
Eigen::MatrixXd least_norm_solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace ricochet
