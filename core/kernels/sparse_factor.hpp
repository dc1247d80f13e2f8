#pragma once
#include <memory>
#include <ricochet/kernels/sparse_substitution.hpp>
#include <vector>

namespace ricochet {

/// Symmetric matrices up to this half-bandwidth are factorised as bands, as those of beams and bars are. Wider ones
/// have fewer entries in a sparse factor.
constexpr int narrow_band = 8;

/// A = Pᵀ L D Lᵀ P of a sparse symmetric matrix, by blocks of columns. It does not change: threads may share it.
class SparseFactor {
 public:
  /// Made once for matrices with the same bits, for as long as somebody holds it; null where SparseLdlt has no factor.
  static std::shared_ptr<const SparseFactor> of(const Eigen::SparseMatrix<double>& A);

  int size() const { return through_.rows(); }
  /// D, and the row of A of each of its numbers.
  const std::vector<double>& pivot() const { return pivot_; }
  const std::vector<int>& order() const { return order_; }
  bool positive() const;

  /// x = A⁻¹ b, which may be the same; `work` has size() + 1 numbers that start on 32 bytes. No allocation.
  void solve(const double* b, double* x, double* work) const;
  /// xᵀA x = Σ_j D_j (Lᵀ P x)_j²: of a positive matrix no sum of large numbers of both signs.
  double form(const double* x, double* work) const;

 private:
  explicit SparseFactor(const SparseLdlt& ldlt);

  SparseSubstitution through_;
  std::vector<double> pivot_;
  std::vector<int> order_;
};

}  // namespace ricochet
