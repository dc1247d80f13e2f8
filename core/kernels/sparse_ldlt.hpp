#pragma once
#include <Eigen/SparseCore>
#include <ricochet/contract/mass_strategy.hpp>
#include <ricochet/kernels/band_ldlt.hpp>
#include <ricochet/kernels/lane_kernels.hpp>
#include <string>
#include <vector>

namespace ricochet {

/// P A Pᵀ = L D Lᵀ for a sparse symmetric A (n × n): simplicial, up-looking, without pivoting (CHOLMOD; Davis, Hager
/// 2009).
///
/// It exists whatever the permutation P for every positive definite A. The same holds for every quasi-definite
/// A = [E Bᵀ; B −F] with E and F positive definite (Vanderbei 1995). P is the natural order or approximate minimum
/// degree, whichever fills less. One object serves one thread at a time.
class SparseLdlt {
 public:
  /// Factorises A, of which only the upper triangle is read. False, with a sentence in reason(), when A is not square
  /// or when memory runs out. Also false when a pivot is not finite or is lost in round-off:
  ///     |D_j| ≤ 16 ε (|A_jj| + Σ_k L_jk² |D_k|)
  /// (the pivot is the difference of these terms). A factorisation held before is gone in either case.
  bool factorise(const Eigen::SparseMatrix<double>& A);
  /// Why the last factorise() returned false, "" when it returned true.
  const std::string& reason() const { return reason_; }

  /// x = A⁻¹ b, n numbers each, which may be the same. No refinement; no allocation. Only after factorise() returned
  /// true.
  void solve(const double* b, double* x);

  /// L by columns without its diagonal, D, and P. Entries of column j stand from start()[j] to start()[j + 1]; row j of
  /// L is row order()[j] of A. For those who substitute by themselves.
  const std::vector<int>& order() const { return order_; }
  const std::vector<int>& start() const { return start_; }
  const std::vector<int>& row() const { return row_; }
  const std::vector<double>& value() const { return value_; }
  const std::vector<double>& pivot() const { return pivot_; }

  /// n; 0 without factorisation.
  int size() const { return size_; }
  /// Entries of L below its diagonal: a solve costs four flops for each, and five for each unknown.
  long factor_entries() const { return size_ == 0 ? 0 : start_[static_cast<std::size_t>(size_)]; }

 private:
  bool refuse(std::string sentence);
  bool refuse_pivot(int step);

  int size_ = 0;
  std::string reason_;
  // CHOLMOD's factor, repacked: its own solve allocates on every call for a single right-hand side. The workspaces of
  // cholmod_solve2 do not help: CHOLMOD 3.0.14 changes their shape and then rejects them.
  std::vector<int> order_, start_, row_;  // P, columns of L without the diagonal
  std::vector<double> value_, pivot_, work_;
};

/// What the factor of a matrix with this pattern takes, which is counted without making it: entries of L below its
/// diagonal, and operations.
struct SparseFill {
  double entries = 0, operations = 0;
};
SparseFill sparse_fill(const Eigen::SparseMatrix<double>& A);

/// S = k K + m M as (1) of band_ldlt.hpp. A mass that is not assembled enters through its border, scaled so that both
/// blocks have the same units. K is n × n; m ≥ 0.
QuasiDefinite weighted_system(double k, const SparseMatrix& stiffness, double m, const Inertia& inertia);

}  // namespace ricochet
