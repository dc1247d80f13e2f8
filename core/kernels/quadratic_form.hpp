#pragma once
#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/block.hpp>
#include <ricochet/kernels/sparse_factor.hpp>
#include <vector>

namespace ricochet {

/// xᵀA y for a symmetric positive semidefinite A, or M = Bᵀ C_v⁻¹ B given by its factors (never formed;
/// B = I and C_v = M⁻¹ where the inverse is given).
/// One lane, x and y contiguous. No allocation after construction. A definite matrix of no narrow band has its squares
/// by a factor that others may share; products of two vectors by rows.
class QuadraticForm {
 public:
  QuadraticForm() = default;
  explicit QuadraticForm(const SparseMatrix& matrix);
  QuadraticForm(const SparseMatrix& coupling, const SparseMatrix& velocity_mass);
  /// A mass is as well conditioned as its elements: of no narrow band it goes by rows alone.
  static QuadraticForm of(const Inertia& inertia);
  /// By rows of A, where it has no narrow band: a pass over its entries in place of one over its factor. What A x loses
  /// of a smooth x is lost, so it is for what is added up at every step, and not for energies.
  QuadraticForm by_rows() const;
  static QuadraticForm by_rows(const SparseMatrix& matrix);

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
  struct Rows;
  void put_rows(const SparseMatrix& matrix);
  void reduce(const double* x, std::vector<double>& out) const;  // L⁻¹ B x
  void strain(const double* x, std::vector<double>& out) const;  // Lᵀ x
  int rows_ = 0, width_ = 0;
  std::vector<double> diagonals_;  // (w+1) × n: A[i, i+s], or L[i+s, i]
  std::vector<double> pivot_;      // D of A, empty when A is not definite
  // Of no narrow band: entries right of the diagonal and half of it; a factor where A is definite.
  std::shared_ptr<const Rows> sparse_;
  std::shared_ptr<const SparseFactor> factor_;
  // Factored form: B by rows, C_v = L D Lᵀ.
  std::vector<int> start_, index_;
  std::vector<double> value_, lower_, inverse_pivot_;
  int velocity_width_ = 0;
  mutable std::vector<double> first_, second_;
  mutable Block work_;
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
  Eigen::VectorXd substitute(Eigen::VectorXd right) const;

  BandLdlt ldlt_;
  std::shared_ptr<const SparseFactor> factor_;  // in its place where the band is not narrow
  std::vector<int> order_;                      // unknown of each row
  bool factorised_ = false;
};

/// xᵀA x and hᵀx of x = x_0 + Σ_k r_k x_k, in one pass over the x_k: for what is added up at every step. Rounded
/// otherwise than QuadraticForm, as well or better; the same on every instruction set that fuses a product and a sum.
/// One lane. No allocation after construction.
class CombinedForm {
 public:
  static constexpr int most_terms = 4;
  struct Value {
    double form = 0, projection = 0;
  };

  CombinedForm() = default;
  /// h: as many numbers as A has rows; null: zeros.
  explicit CombinedForm(const QuadraticForm& form, const double* h = nullptr);

  /// 1 ≤ count ≤ most_terms; `ratio` holds r_0 = 1, r_1, …; where `out` is given, x itself is written to it. Each x_k
  /// and `out` are blocks of one lane, or start on 32 bytes with room up to a whole number of fours.
  Value operator()(int count, const double* const* x, const double* ratio, double* out = nullptr) const {
    return kernels_ ? kernels_[count - 1]({rows_, fours_.data()}, x, ratio, out) : at_length(count, x, ratio, out);
  }
  Value operator()(const double* x) const {
    constexpr double one = 1;
    return (*this)(1, &x, &one);
  }

  /// What a kernel reads. Fours of rows, of each W fours l_1 … l_W, then the pivots, then h; zero beyond the last row.
  struct Packed {
    int rows = 0;
    const double* fours = nullptr;
  };
  /// These fours, zeros where A is narrower; empty where it is wider than W or no sum of squares.
  static Block packed(const QuadraticForm& form, const double* h, int width);
  using Kernel = Value (*)(const Packed& packed, const double* const* x, const double* ratio, double* out);

 private:
  Value at_length(int count, const double* const* x, const double* ratio, double* out) const;

  int rows_ = 0;
  const Kernel* kernels_ = nullptr;  // by count; null: of another width, or given by factors
  Block fours_;
  QuadraticForm general_;
  Block shape_;
  mutable Block combined_;
};

}  // namespace ricochet
