#pragma once
#include <Eigen/SparseCore>
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/block.hpp>
#include <vector>

namespace ricochet {

/// xᵀA y for a symmetric positive semidefinite A that is banded, or M = Bᵀ C_v⁻¹ B given by its factors (never formed;
/// B = I and C_v = M⁻¹ where the inverse is given).
/// One lane, x and y contiguous. No allocation after construction.
class QuadraticForm {
 public:
  QuadraticForm() = default;
  explicit QuadraticForm(const SparseMatrix& matrix);
  QuadraticForm(const SparseMatrix& coupling, const SparseMatrix& velocity_mass);
  static QuadraticForm of(const Inertia& inertia);

  double operator()(const double* x) const;
  double operator()(const double* x, const double* y) const;
  int rows() const { return rows_; }
  /// xᵀA x = Σ_i d_i (x_i + Σ_s l_si x_{i+s})², s = 1 … width, where A is a diagonal or positive definite.
  struct Squares {
    int width = 0;
    const double* upper = nullptr;  ///< (width+1) × n; l_s by rows s ≥ 1, zero beyond the last column
    const double* pivot = nullptr;  ///< d, n
  };
  std::optional<Squares> squares() const;
  /// Whether A is the unit matrix.
  bool unit() const;

 private:
  void reduce(const double* x, std::vector<double>& out) const;  // L⁻¹ B x
  void strain(const double* x, std::vector<double>& out) const;  // Lᵀ x
  int rows_ = 0, width_ = 0;
  std::vector<double> diagonals_;  // (w+1) × n: A[i, i+s], or L[i+s, i]
  std::vector<double> pivot_;      // D of A, empty when A is not definite
  // Factored form: B by rows, C_v = L D Lᵀ.
  std::vector<int> start_, index_;
  std::vector<double> value_, lower_, inverse_pivot_;
  int velocity_width_ = 0;
  mutable std::vector<double> first_, second_;
};

/// An inverse and its quadratic form, factorised once.
class InverseForm {
 public:
  explicit InverseForm(const QuasiDefinite& matrix);
  /// bᵀ z with (A + Gᵀ C_v⁻¹ G) z = b: twice the energy that a load b stores in A. Nothing where the matrix has no L D
  /// Lᵀ.
  std::optional<double> operator()(const Eigen::VectorXd& b) const;
  /// z itself.
  std::optional<Eigen::VectorXd> solve(const Eigen::VectorXd& b) const;

 private:
  Eigen::VectorXd in_factor_order(const Eigen::VectorXd& b) const;
  Block substitute(Eigen::VectorXd right) const;

  BandLdlt ldlt_;
  bool factorised_;
};

}  // namespace ricochet
