#pragma once
#include <ricochet/algebra/lane_kernels.hpp>
#include <ricochet/algebra/sparse_ldlt.hpp>
#include <vector>

namespace ricochet {

/// A sparse factor as SparseStep reads it: L by rows for the way down, by columns for the way up.
class SparseSubstitution {
 public:
  SparseSubstitution() = default;
  /// `order`: the unknown of each row of the matrix that was factorised. Those from `known` on have no right-hand side,
  /// those from `wanted` on no place in z.
  SparseSubstitution(const SparseLdlt& ldlt, const std::vector<int>& order, int known, int wanted);
  int rows() const { return static_cast<int>(inverse_.size()); }
  /// Without blocks.
  SparseStep step() const;

 private:
  std::vector<int> lower_start_, lower_index_, upper_start_, upper_index_, from_, to_;
  std::vector<double> lower_, upper_, inverse_;
};

}  // namespace ricochet
